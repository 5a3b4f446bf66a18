"""Two ends of a cable inside this computer, and `openacr bus emulate` on one of them."""

import os
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass

import pytest
from tests import warm

LINES_S = 60.0


@dataclass
class Emulated:
    """A running emulator; `say` types a fault and returns the line that answers."""

    interface: str
    process: warm.Popen

    def say(self, text: str) -> str:
        assert self.process.stdin is not None
        self.process.stdin.write(text + "\n")
        self.process.stdin.flush()
        return self.line()

    def line(self) -> str:
        assert self.process.stdout is not None
        return str(self.process.stdout.readline()).rstrip()

    def end(self) -> str:
        """End it as Ctrl-C does; what it prints then."""
        self.process.terminate()
        return str(self.process.communicate(timeout=LINES_S)[0])


@contextmanager
def emulated(*words: str) -> Iterator[Emulated]:
    """The master's end of a cable, with slaves on the other; skips without the right to it."""
    own, other = f"oem{os.getpid()}", f"oes{os.getpid()}"
    if shutil.which("ip") is None:
        pytest.skip("no command `ip`: no network interfaces can be made")
    made = subprocess.run(
        ["ip", "link", "add", own, "type", "veth", "peer", "name", other],
        capture_output=True,
        check=False,
    )
    if made.returncode:
        pytest.skip("veth interfaces need root and a kernel that has them")
    try:
        for each in (own, other):
            subprocess.run(["ip", "link", "set", each, "up"], check=True)
        process = warm.Popen(
            ["bus", "emulate", "--interface", other, *words],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            encoding="utf-8",
        )
        one = Emulated(own, process)
        assert one.line().startswith(f"emulating on {other}: 0 ")
        try:
            yield one
        finally:
            with suppress(ProcessLookupError):
                process.kill()
            process.communicate(timeout=LINES_S)
    finally:
        subprocess.run(["ip", "link", "delete", own], check=False)
