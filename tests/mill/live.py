"""A served card, machines that are run on it, and a line between them: real processes.

Everything here waits for an event with a generous limit, so that a busy computer makes a
test slow and never wrong.
"""

import os
import re
import select
import signal
import subprocess
import threading
import tty
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from tests import warm
from tests.waiting import LIMIT_S, until

from openacr.client import Card
from openacr.cnc.occupied import TRIPPED, WATCHDOG_PROGRAM
from openacr.controller.journal import read_journal
from openacr.controller.replay import Replay
from openacr.controller.trace import Trace
from openacr.engine.samples import Sample
from openacr.map.numbers import P_GLOBAL_SYSTEM_CLOCK as CLOCK
from openacr.map.words import af1, mf1
from openacr.sysvar import Store

AXIS_POSITION, AXIS_STRIDE = 12288, 256
REST_MS = 300  # of the card, in which nothing has moved
LONG_AGO_MS = 1_000_000
SERVE = ("serve", "--ascii-port", "0", "--binary-port", "0")

SPINDLE, FLOOD, LINK_TIMEOUT = 40, 41, 250_126
PATIENT_S = 60.0  # for hosts that have to live on a busy computer
SPINDLE_CELLS = {
    800_005: SPINDLE, 800_010: FLOOD, 800_002: 3, 800_001: 0.01, LINK_TIMEOUT: PATIENT_S,
}  # fmt: skip
LONG = "M3 S500\nM8\nF60\nG1 X100\nM2\n"  # with spindle and coolant


class Process:
    """One openacr command, with all it says."""

    def __init__(self, *words: str, store: Path, stdin: int | None = subprocess.DEVNULL) -> None:
        self._process = warm.Popen(
            [*words],
            stdin=stdin,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            env={**os.environ, "OPENACR_STORE": str(store), "COLUMNS": "200"},
        )
        self._text: list[str] = []
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        assert self._process.stdout is not None
        for line in self._process.stdout:
            self._text.append(line)

    @property
    def text(self) -> str:
        """What it has said so far."""
        return "".join(self._text)

    @property
    def is_alive(self) -> bool:
        return self._process.poll() is None

    def signal(self, number: signal.Signals) -> None:
        self._process.send_signal(number)

    def ended(self, limit_s: float = LIMIT_S) -> int:
        """Its exit code, once it has ended."""
        code = self._process.wait(limit_s)
        self._reader.join(limit_s)
        return code

    def close(self) -> None:
        if self.is_alive:
            self._process.kill()
            self._process.wait(LIMIT_S)
        self._reader.join(LIMIT_S)
        assert self._process.stdout is not None
        self._process.stdout.close()


@contextmanager
def serial_line() -> Iterator[tuple[str, str]]:
    """The two ends of a serial line, as ports to be opened."""
    masters, names, slaves = [], [], []
    for _ in range(2):
        master, slave = os.openpty()
        tty.setraw(slave)
        masters.append(master)
        slaves.append(slave)
        names.append(os.ttyname(slave))
    is_over = threading.Event()

    def copy() -> None:
        while not is_over.is_set():
            for end in select.select(masters, [], [], 0.05)[0]:
                with suppress(OSError):
                    os.write(masters[1 - masters.index(end)], os.read(end, 4096))

    copying = threading.Thread(target=copy, daemon=True)
    copying.start()
    yield names[0], names[1]
    is_over.set()
    copying.join()
    for end in (*masters, *slaves):
        os.close(end)


class Plant:
    """A served card, seen through a connection of its own."""

    def __init__(self, folder: Path, *words: str, is_journalled: bool = False) -> None:
        self.folder = folder
        self.store = folder / "sysvar.db"
        self._processes: list[Process] = []
        self._journal = folder / "journal"
        kept = ("--journal", str(self._journal)) if is_journalled else ("--no-journal",)
        self.served = self._started(*SERVE, *kept, *words)
        until(lambda: "ascii=" in self.served.text, about="the card is served")
        found = re.search(r"ascii=(\S+)", self.served.text)
        assert found is not None
        self.address = found[1]
        self.card = Card.open(self.address)

    def _started(self, *words: str, stdin: int | None = subprocess.DEVNULL) -> Process:
        process = Process(*words, store=self.store, stdin=stdin)
        self._processes.append(process)
        return process

    def wire(self, cells: dict[int, float]) -> None:
        """Cells of the store of the machine."""
        with Store(self.store) as store:
            for number, value in cells.items():
                store.write(number, value)

    def part(self, text: str) -> str:
        """A part program in a file."""
        path = self.folder / "PART.NC"
        path.write_text(text)
        return str(path)

    def mill(self, *words: str, host: str = "", stdin: int | None = subprocess.DEVNULL) -> Process:
        """Start a command of the machine on the card."""
        return self._started("mill", *words, "--host", host or self.address, stdin=stdin)

    @property
    def is_moving(self) -> bool:
        words = self.card.read_many([mf1.word[0], *(af1.word[axis] for axis in range(3))])
        master, *axes = map(int, words)
        return bool(master & mf1.IN_MOTION) or any(word & af1.JOG_ACTIVE for word in axes)

    def places(self) -> list[int]:
        """Where the axes are commanded to stand, jogs included, in pulses."""
        rows = [AXIS_POSITION + AXIS_STRIDE * axis + k for axis in range(3) for k in (0, 9)]
        values = [int(value) for value in self.card.read_many(rows)]
        return [sum(values[2 * axis : 2 * axis + 2]) for axis in range(3)]

    @property
    def is_at_rest(self) -> bool:
        """Whether no axis moves for a third of a second of the card, however slow the computer."""
        before, begun_ms = self.places(), self.card.read(CLOCK)
        until(lambda: self.card.read(CLOCK) - begun_ms >= REST_MS)
        return self.places() == before

    def trip(self) -> None:
        """Wait until the watchdog has tripped for which the last beat of its host is long ago."""

        def has_tripped() -> bool:
            self.card.command(f"LV1=LV1-{LONG_AGO_MS}", program=WATCHDOG_PROGRAM)
            return self.card.read_bit(TRIPPED)

        until(has_tripped)

    def lived_again(self, *samples: Sample) -> Trace:
        """The samples of every tick of the card, which is ended and lives again by its journal."""
        self.card.close()
        self.served.signal(signal.SIGTERM)
        self.served.ended()
        (path,) = self._journal.rglob("*.journal")
        again = Replay(read_journal(path))
        again.card.record(samples=samples)
        again.run()
        assert again.difference is None
        return again.card.trace()

    def outputs(self, *numbers: int) -> list[bool]:
        return self.card.read_bits(numbers)

    def close(self) -> None:
        self.card.close()
        for process in self._processes:
            process.close()
