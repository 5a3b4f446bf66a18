"""An emulated segment on a network interface: a raw socket, which needs the right to have one."""

import errno
import heapq
import select
import socket
import time
from collections.abc import Iterable
from contextlib import suppress
from struct import Struct

from openacr.errors import UserError
from openacr.fieldbus.ethercat.emulated.faults import Line
from openacr.fieldbus.ethercat.wire.frames import ETHERTYPE

IDLE_S = 0.01  # how often time passes for the motors without a frame
LONGEST = 2048
_TIMESTAMPS = 35  # SO_TIMESTAMPNS
_TIME = Struct("@qq")
_EXTRA = 128  # bytes of what comes beside a frame
_OUTGOING = 4  # the kind of a packet that this computer sent


class Port:
    """Serves a line on an interface until `close`; `poll` is called again and again.

    Time is that of the arrival of a frame, as the kernel notes it: what this process is late does
    not count as a silence of the master.
    """

    def __init__(self, line: Line, interface: str) -> None:
        self.line = line
        self._late: list[tuple[int, int, bytes]] = []
        self._number = 0
        self._socket = _open(interface)

    def poll(self, idle_s: float = IDLE_S, others: Iterable[int] = ()) -> list[int]:
        """Wait for a frame or `idle_s`, and serve what there is.

        `others` are descriptors that end the wait, too; those that have something to read.
        """
        own, now = self._socket.fileno(), time.time_ns()
        if self._late:
            idle_s = min(idle_s, max(0.0, (self._late[0][0] - now) * 1e-9))
        ready = select.select([own, *others], [], [], idle_s)[0]
        if own in ready:
            self._receive()
            ready.remove(own)
        else:
            self.line.segment.advance(time.time_ns())
        while self._late and self._late[0][0] <= time.time_ns():
            self._send(heapq.heappop(self._late)[2])
        return ready

    def _receive(self) -> None:
        try:
            frame, extra, _, sender = self._socket.recvmsg(LONGEST, _EXTRA)
        except OSError as error:
            if error.errno != errno.ENETDOWN:
                raise UserError(f"the interface cannot receive: {error.strerror}") from None
            return
        if sender[2] != _OUTGOING:
            self._serve(frame, _arrival_ns(extra))

    def _serve(self, frame: bytes, now: int) -> None:
        for each in self.line.send(frame, now):
            if each.delay_ns:
                self._number += 1
                heapq.heappush(self._late, (now + each.delay_ns, self._number, each.frame))
            else:
                self._send(each.frame)

    def _send(self, frame: bytes) -> None:
        try:
            self._socket.send(frame)
        except OSError as error:
            if error.errno not in (errno.ENOBUFS, errno.ENETDOWN, errno.EAGAIN):
                raise UserError(f"the interface cannot send: {error.strerror}") from None

    def close(self) -> None:
        """Release the interface."""
        self._socket.close()


def _arrival_ns(extra: list[tuple[int, int, bytes]]) -> int:
    """When the kernel received a frame."""
    for level, kind, data in extra:
        if (level, kind) == (socket.SOL_SOCKET, _TIMESTAMPS) and len(data) >= _TIME.size:
            seconds, nanoseconds = _TIME.unpack_from(data)
            return int(seconds * 1_000_000_000 + nanoseconds)
    return time.time_ns()


def _open(interface: str) -> socket.socket:
    if not hasattr(socket, "AF_PACKET"):
        raise UserError("raw sockets of network interfaces are known on Linux only")
    try:
        one = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(ETHERTYPE))
    except PermissionError:
        raise UserError(
            f"{interface}: a raw socket needs root, or the capability CAP_NET_RAW of this Python"
        ) from None
    try:
        one.bind((interface, ETHERTYPE))
    except OSError as error:
        one.close()
        known = ", ".join(name for _, name in socket.if_nameindex())
        raise UserError(f"{interface}: {error.strerror}; there are {known}") from None
    with suppress(OSError):  # where a kernel does not know them, the present time serves
        one.setsockopt(socket.SOL_SOCKET, _TIMESTAMPS, 1)
    return one
