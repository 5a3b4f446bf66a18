"""A served card and a bare echo server, each a process of its own."""

import os
import re
import socket
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from bench.cards import NAMES

LOOPBACK = "127.0.0.1"
WAIT_S = 20.0
SERVE = """
import logging
logging.basicConfig(level=logging.INFO, format="%(message)s")
from openacr.cli.main import main
main()
"""
ECHO = """
import asyncio, socket

class Echo(asyncio.Protocol):
    def connection_made(self, transport):
        self.transport = transport
        transport.get_extra_info("socket").setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def data_received(self, data):
        self.transport.write(data)

async def main():
    server = await asyncio.get_running_loop().create_server(Echo, "127.0.0.1", 0)
    print(server.sockets[0].getsockname()[1], flush=True)
    await server.serve_forever()

asyncio.run(main())
"""


@dataclass
class Line:
    """One connection."""

    socket: socket.socket

    @classmethod
    def to(cls, port: int) -> "Line":
        """Connect to a port of this machine."""
        connected = socket.create_connection((LOOPBACK, port), WAIT_S)
        connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        return cls(connected)

    def ask(self, data: bytes, end: bytes = b">") -> bytes:
        """Send, and read up to `end`."""
        self.socket.sendall(data)
        seen = b""
        while not seen.endswith(end):
            seen += self._more()
        return seen

    def ask_bytes(self, data: bytes, count: int) -> bytes:
        """Send, and read so many bytes."""
        self.socket.sendall(data)
        seen = b""
        while len(seen) < count:
            seen += self._more()
        return seen

    def _more(self) -> bytes:
        data = self.socket.recv(65536)
        if not data:
            raise RuntimeError("the connection has ended")
        return data


@dataclass
class Served:
    """A served card; `pacing` says after its end how well it has kept time."""

    ascii_port: int
    binary_port: int
    pacing: str = ""


@contextmanager
def served_card(*options: str) -> Iterator[Served]:
    """A card of eight modelled axes in real time."""
    command = [sys.executable, "-c", SERVE, "serve", "--ascii-port", "0", "--binary-port", "0"]
    command += options
    kept = tempfile.TemporaryDirectory()  # the journal, which is part of what is measured
    process = subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ | {"OPENACR_JOURNALS": kept.name},
    )
    if process.stdout is None:
        raise RuntimeError("no output to read")
    found = re.fullmatch(r"listening ascii=.*:(\d+) binary=.*:(\d+)\n", process.stdout.readline())
    if found is None:
        raise RuntimeError(process.communicate()[1])
    served = Served(int(found[1]), int(found[2]))
    try:
        yield served
    finally:
        process.terminate()
        served.pacing = process.communicate(timeout=WAIT_S)[1]
        kept.cleanup()


@contextmanager
def echo_server() -> Iterator[int]:
    """The port of a server that sends back what it gets."""
    process = subprocess.Popen([sys.executable, "-c", ECHO], stdout=subprocess.PIPE, text=True)
    if process.stdout is None:
        raise RuntimeError("no output to read")
    try:
        yield int(process.stdout.readline())
    finally:
        process.kill()
        process.wait()


def start_moving(line: Line, axes: int = 8) -> None:
    """Attach all axes and send them on a way of some minutes."""
    names = NAMES[:axes]
    lines = ["PROG0", "ATTACH MASTER0"]
    lines += [f'ATTACH SLAVE{n} AXIS{n} "{name}"' for n, name in enumerate(names)]
    lines += ["PPU" + "".join(f" {name}1000" for name in names), "ACC 100 DEC 100 STP 100 VEL 1"]
    lines += ["DRIVE ON " + " ".join(names), " ".join(f"{name}1000" for name in names)]
    for text in lines:
        answer = line.ask(text.encode() + b"\r")
        if answer.count(b"\r\n") != 1:
            raise RuntimeError(answer)
