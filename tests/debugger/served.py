"""A served card with programs, in a process of its own."""

from __future__ import annotations

import re
import socket
import subprocess
import threading
from contextlib import suppress
from pathlib import Path
from typing import IO

from tests import warm

from openacr.client import Card
from openacr.map.words import mf1, pf

COUNTS = """\
PROGRAM
DIM LV(2)
DIM SA(1)
DIM SA0(2)
_LOOP
P0=P0+1
LV1=P0*2
DWL 0.01
GOTO LOOP
ENDP
"""
FAILS = """\
PROGRAM
PRINT "HELLO"
P6=1/P7
ENDP
"""
MOVES = """\
PROGRAM
DRIVE ON X
ACC 1000 DEC 1000 STP 1000 VEL 10
X/1000
X/1000
_LOOP
DWL 0.1
GOTO LOOP
ENDP
"""
WAITS = """\
PROGRAM
INH 128
P1=P1+1
INH 129
ENDP
"""
ENDS = """\
PROGRAM
DRIVE ON Y
ACC 1000 DEC 1000 STP 1000 VEL 10
Y/1000
ENDP
"""
PLC = "10 LD 40\n20 OUT 41\n"
SETUP = """\
SYS
DIM P(20)
DIM PLC0(1000)
DIM PROG3(1000)
PROG2
ATTACH MASTER0
ATTACH SLAVE0 AXIS0 "X"
PPU X1000
PROG4
ATTACH MASTER1
ATTACH SLAVE0 AXIS1 "Y"
PPU Y1000
"""
FILES = {
    "setup": SETUP, "prog0": COUNTS, "prog1": FAILS, "prog2": MOVES, "prog3": WAITS,
    "prog4": ENDS, "plc0": PLC,
}  # fmt: skip


class Served:
    """`openacr serve` with these programs; `address` is its terminal port."""

    def __init__(self, folder: Path) -> None:
        folder.mkdir()
        for name, text in FILES.items():
            (folder / f"{name}.8k").write_text(text)
        words = ("serve", str(folder), "--ascii-port", "0", "--binary-port", "0", "--no-journal")
        self.process = warm.Popen([*words], stdout=subprocess.PIPE, text=True)
        assert self.process.stdout is not None
        self.address = self._address(self.process.stdout)

    def _address(self, lines: IO[str]) -> str:
        for line in lines:
            if found := re.search(r"ascii=(\S+)", line):
                return found[1]
        self.kill()
        raise AssertionError("the card is not served")

    def kill(self) -> None:
        self.process.kill()
        self.process.wait()
        assert self.process.stdout is not None
        self.process.stdout.close()


class Relay:
    """A line to a card that can be cut; new connections go through again."""

    def __init__(self, address: str) -> None:
        host, _, port = address.rpartition(":")
        self._card = host, int(port)
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.address = f"127.0.0.1:{self._listener.getsockname()[1]}"
        self._ends: list[socket.socket] = []
        threading.Thread(target=self._accept, daemon=True).start()

    def _accept(self) -> None:
        with suppress(OSError):
            while True:
                ends = self._listener.accept()[0], socket.create_connection(self._card)
                self._ends += ends
                for one, other in (ends, ends[::-1]):
                    threading.Thread(target=self._pass, args=(one, other), daemon=True).start()

    def _pass(self, one: socket.socket, other: socket.socket) -> None:
        with suppress(OSError):
            while data := one.recv(4096):
                other.sendall(data)
        with suppress(OSError):
            other.shutdown(socket.SHUT_RDWR)

    def cut(self) -> None:
        """Break the connections there are."""
        for end in self._ends:
            with suppress(OSError):
                end.shutdown(socket.SHUT_RDWR)

    def __enter__(self) -> Relay:
        return self

    def __exit__(self, *_: object) -> None:
        self.cut()
        self._listener.close()
        for end in self._ends:
            end.close()


def flags(card: Card, program: int) -> int:
    return int(card.read(pf.word[program]))


def is_running(card: Card, program: int) -> bool:
    return bool(flags(card, program) & pf.PROGRAM_RUNNING)


def is_moving(card: Card, master: int = 0) -> bool:
    return bool(int(card.read(mf1.word[master])) & mf1.IN_MOTION)
