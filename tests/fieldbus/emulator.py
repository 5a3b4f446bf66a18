"""`openacr bus emulate` as a process."""

import subprocess
from collections.abc import Iterator
from contextlib import contextmanager, suppress

from tests import warm
from tests.waiting import LIMIT_S


class Emulator:
    """A running emulator; `say` types an order and returns the line that answers."""

    def __init__(self, interface: str, *words: str) -> None:
        self.interface = interface
        self.process = warm.Popen(
            ["bus", "emulate", *words], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT, text=True, encoding="utf-8",
        )  # fmt: skip

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
        return str(self.process.communicate(timeout=LIMIT_S)[0])


@contextmanager
def emulating(interface: str, *words: str) -> Iterator[Emulator]:
    """An emulator that ends with the block; its master is on this interface."""
    one = Emulator(interface, *words)
    try:
        yield one
    finally:
        with suppress(ProcessLookupError):
            one.process.kill()
        one.process.communicate(timeout=LIMIT_S)
