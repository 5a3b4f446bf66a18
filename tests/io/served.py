"""`openacr serve` as a process, and a plain blocking host for it."""

import re
import socket
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from tests import warm

WAIT_S = 60.0
LOOPBACK = "127.0.0.1"


class Caller:
    """One connection; reading waits, but not for ever."""

    def __init__(self, port: int) -> None:
        self.socket = socket.create_connection((LOOPBACK, port), WAIT_S)

    def __enter__(self) -> "Caller":
        return self

    def __exit__(self, *_: object) -> None:
        self.socket.close()

    def send(self, data: bytes) -> None:
        self.socket.sendall(data)

    def until(self, end: bytes) -> bytes:
        seen = b""
        while not seen.endswith(end):
            data = self.socket.recv(65536)
            assert data, f"closed after {seen!r}"
            seen += data
        return seen

    def ask(self, line: str, prompt: str = ">") -> str:
        """What is sent for a line, echo and prompt included."""
        self.send(line.encode("latin-1") + b"\r")
        return self.until(prompt.encode()).decode("latin-1")

    def value(self, query: str) -> str:
        return self.ask(query).split("\r\n")[1]

    def exactly(self, count: int) -> bytes:
        data = b""
        while len(data) < count:
            found = self.socket.recv(count - len(data))
            assert found
            data += found
        return data


@dataclass
class Served:
    """A running server."""

    process: "subprocess.Popen[str]"
    ascii_port: int
    binary_port: int
    status_port: int = 0

    def call(self) -> Caller:
        return Caller(self.ascii_port)

    def call_binary(self) -> Caller:
        return Caller(self.binary_port)

    def end(self) -> tuple[int, str]:
        """SIGTERM; exit code and standard error."""
        self.process.terminate()
        _, error = self.process.communicate(timeout=WAIT_S)
        return self.process.returncode, error


LISTENING = (
    r"listening ascii=[\d.]+:(\d+) binary=[\d.]+:(\d+)(?: serial=\S+)?(?: status=[\d.]+:(\d+))?\n"
)


@contextmanager
def serving(*arguments: str | Path) -> Iterator[Served]:
    """A server on free ports of this machine."""
    command = ["serve", "--ascii-port", "0", "--binary-port", "0", *map(str, arguments)]
    with warm.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            line = process.stdout.readline()
            found = re.fullmatch(LISTENING, line)
            assert found, f"{line!r}: {process.stderr.read() if process.stderr else ''}"
            yield Served(process, int(found[1]), int(found[2]), int(found[3] or 0))
        finally:
            if process.poll() is None:
                process.kill()


def openacr(*arguments: str, text: str = "") -> "subprocess.CompletedProcess[str]":
    """Run the command line to its end."""
    return warm.run([*arguments], input=text, capture_output=True, text=True, timeout=WAIT_S)
