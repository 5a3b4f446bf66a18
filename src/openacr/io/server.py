"""Serves one card to many hosts in real time, in one asyncio loop.

Card time follows the wall clock in steps of at most a millisecond. A query does not wait
for the next step: when bytes arrive, the card is advanced to now, given the bytes, and
advanced on, at most AHEAD_S before the clock, until the answer is there. A card that has much to
compute is left after WORK_S, so that the other hosts are read, Ctrl-X first of all.
"""

import asyncio
import ipaddress
import logging
import socket
import time
from dataclasses import dataclass

from openacr.channels import StreamKind
from openacr.errors import NoFreeStreamError, UserError
from openacr.host import CardHost
from openacr.io import peers, status_port
from openacr.io.bounded_log import bounded
from openacr.io.listening import bound_socket
from openacr.io.pacing import Pacer, PacingReport
from openacr.io.peers import Peer, TcpPeer
from openacr.io.serial_port import LineSettings, SerialPeer
from openacr.io.status_port import StatusPort, open_status_port
from openacr.protocol import terminal

STEP_S = 0.001
WORK_S = 0.003  # computing of the card between two looks at the sockets
CONNECTIONS = 16  # hosts at a time

log = logging.getLogger(__name__)
# Loggers a host can make write as often as it connects.
OF_HOSTS = (log, *map(logging.getLogger, (peers.__name__, status_port.__name__, terminal.__name__)))


@dataclass(frozen=True, slots=True)
class Address:
    """The address of a listening port."""

    host: str
    port: int

    def __str__(self) -> str:
        return f"[{self.host}]:{self.port}" if ":" in self.host else f"{self.host}:{self.port}"

    @property
    def is_loopback(self) -> bool:
        """Whether only programs on this machine can reach it."""
        return is_loopback(self.host)


def is_loopback(host: str) -> bool:
    """Whether only programs on this machine can reach an address or name."""
    try:
        found = socket.getaddrinfo(host, None, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)
    except OSError:
        return True  # listening there will fail and report why
    return all(
        ipaddress.ip_address(str(address[0]).partition("%")[0]).is_loopback for *_, address in found
    )


@dataclass(frozen=True, slots=True)
class Guests:
    """The networks hosts may connect from; without any, every host that reaches the port."""

    networks: tuple[ipaddress.IPv4Network | ipaddress.IPv6Network, ...] = ()

    def __str__(self) -> str:
        named = [str(network) for network in self.networks if not network.is_loopback]
        return f"every host in {', '.join(named)}" if named else "every host that connects"

    @classmethod
    def of(cls, text: str) -> "Guests":
        """Networks as `192.168.10.0/24,10.0.0.7`; this machine is always among them."""
        try:
            named = [ipaddress.ip_network(each.strip()) for each in text.split(",")]
        except ValueError as wrong:
            raise UserError(f"{wrong}; write networks like 192.168.10.0/24,10.0.0.7") from None
        return cls((*named, ipaddress.ip_network("127.0.0.0/8"), ipaddress.ip_network("::1")))

    def admits(self, host: str) -> bool:
        """Whether an address belongs to one of the networks."""
        if not self.networks:
            return True
        address = ipaddress.ip_address(host.partition("%")[0])
        mapped = getattr(address, "ipv4_mapped", None)  # ::ffff:10.0.0.7 of a dual socket
        return any((mapped or address) in network for network in self.networks)


class CardServer:
    """One card, its listening ports and its peers."""

    def __init__(
        self,
        card: CardHost,
        *,
        speed: float = 1.0,
        allowed: Guests | None = None,
        keeps_time: bool = False,
    ) -> None:
        self._card = card
        self.allowed = allowed or Guests()
        self._pacer = Pacer(card.period_s, speed, keeps_time=keeps_time)
        self._peers: list[Peer] = []
        self._listeners: list[asyncio.Server] = []
        self._status: StatusPort | None = None
        self._now = time.monotonic
        self._work_s = time.thread_time
        self._worked_s = 0.0  # since the sockets were looked at
        self._step_tk = max(1, round(STEP_S / card.period_s))

    # --- set-up and end ---------------------------------------------------------------

    async def listen(self, kind: StreamKind, host: str, port: int) -> Address:
        """Open one TCP port (0: any free one); UserError if impossible."""
        option = "--ascii-port" if kind is StreamKind.TERMINAL else "--binary-port"
        sock = bound_socket(host, port, socket.SOCK_STREAM, option)
        loop = asyncio.get_running_loop()
        listener = await loop.create_server(lambda: TcpPeer(kind, self), sock=sock)
        self._listeners.append(listener)
        name = sock.getsockname()
        return Address(name[0], name[1])

    async def listen_status(self, host: str, port: int) -> Address:
        """Open the UDP port of the fast status; UserError if impossible."""
        sock = bound_socket(host, port, socket.SOCK_DGRAM, "--status-port")
        self._status = await open_status_port(self, self._now, sock)
        name = sock.getsockname()
        return Address(name[0], name[1])

    def open_serial(self, path: str, line: LineSettings) -> None:
        """Serve a serial port as well; UserError when it cannot be opened."""
        SerialPeer(path, line, self, asyncio.get_running_loop()).start()

    async def run(self, stop: asyncio.Event) -> None:
        """Run the card in real time until `stop` is set; then close everything."""
        self._pacer.start(self._now())
        with bounded(self._now, *OF_HOSTS):
            await self._run(stop)

    async def _run(self, stop: asyncio.Event) -> None:
        try:
            while not stop.is_set():
                self._worked_s = 0.0
                self._catch_up()
                self._serve_all()
                if self._status is not None:
                    self._status.send_due(self._card.fast_status)
                await asyncio.sleep(self._pacer.pause_s(self._now(), STEP_S))
        finally:
            await self.close()

    def refused(self, name: str, why: str) -> None:
        """Log that a connection from `name` was refused, with the reason."""
        log.warning("%s refused: %s", name, why)

    async def close(self) -> None:
        """Stop listening and end every connection."""
        for listener in self._listeners:
            listener.close()
        if self._status is not None:
            self._status.close()
        for peer in list(self._peers):
            peer.close()
        await asyncio.sleep(0)  # lets the transports report their end

    def report(self) -> PacingReport:
        """The accuracy of real time so far."""
        return self._pacer.report()

    # --- time -------------------------------------------------------------------------

    def _catch_up(self) -> None:
        """Advance the card to now, or as far as it comes while no host waits for long."""
        due_tk = self._pacer.due_tk(self._now())
        while due_tk > 0 and self._worked_s < WORK_S:
            step_tk = min(due_tk, self._step_tk)
            self._advance(step_tk)
            due_tk -= step_tk

    def _advance(self, ticks: int) -> None:
        began_s = self._work_s()
        self._card.advance(ticks)
        self._pacer.advanced(ticks)
        self._worked_s += self._work_s() - began_s

    def _serve_all(self) -> None:
        for peer in list(self._peers):
            self._flush(peer)
            peer.hold(not self._card.accepts_input(peer.stream))

    def _flush(self, peer: Peer) -> None:
        while peer.takes_output and (data := self._card.take_output(peer.stream)):
            peer.send(data)

    # --- peers ------------------------------------------------------------------------

    def admits(self, host: str) -> bool:
        """Whether a host may connect at all."""
        return self.allowed.admits(host)

    def hosts(self) -> set[str]:
        """The addresses of the hosts that are connected."""
        return {peer.host for peer in self._peers}

    def joined(self, peer: Peer) -> bool:
        """Give a new peer a stream of the card."""
        if len(self._peers) >= CONNECTIONS:
            return False
        try:
            peer.stream = self._card.open_stream(peer.kind)
        except NoFreeStreamError:
            return False
        self._peers.append(peer)
        return True

    def received(self, peer: Peer, data: bytes) -> None:
        """Pass received bytes to the card and, if possible, send the answer at once."""
        self._catch_up()
        self._card.receive(peer.stream, data)
        self._flush(peer)
        while self._card.replying(peer.stream) and self._pacer.may_run_ahead(self._now()):
            self._advance(1)
            self._flush(peer)
        peer.hold(not self._card.accepts_input(peer.stream))

    def left(self, peer: Peer) -> None:
        """Free the stream of a peer that has disconnected."""
        self._peers.remove(peer)
        self._card.close_stream(peer.stream)
