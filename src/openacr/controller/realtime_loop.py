"""The thread of the real-time loop, and the memory that it shares with Python."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from openacr.compiled import is_compiled, pick
from openacr.engine import change_log_cy, quiet_cy
from openacr.engine import realtime_cy as loop
from openacr.engine.changes import Changes
from openacr.engine.changes_cy import ENTRY
from openacr.errors import UserError
from openacr.fieldbus.machine.exchange_memory import ExchangeMemory
from openacr.map.memory import Memory
from openacr.map.numbers import HEAP_BYTE_BASE, MEMORY_BYTES
from openacr.views import F64, I32

if TYPE_CHECKING:
    from openacr.fieldbus.machine.report import LoopReport, TimesReport

CODE_WORDS = 1 << 21  # room for what all programs are compiled to
CODE_NUMBERS = 1 << 19
MOST_ENTRIES = MEMORY_BYTES // 4 + 4096  # every word, and calls
POLL_S = 50e-6
GONE_TIMES = 10.0  # the silence after which Python is taken for dead
REST_S = 15.0  # for all axes to come to rest at the end

_realtime_run = pick(loop.realtime_run)
_realtime_give = pick(loop.realtime_give)
_realtime_sequence = pick(loop.realtime_sequence)


def whole(count: int) -> I32:
    """Zeros of 32 bits."""
    return memoryview(bytearray(4 * count)).cast("i")


def real(count: int) -> F64:
    """Zeros of 64 bits."""
    return memoryview(bytearray(8 * count)).cast("d")


@dataclass(frozen=True, slots=True)
class Times:
    """What a histogram of the loop says, in seconds; bins of a microsecond."""

    median_s: float
    most_s: float  # of 99.99 %
    worst_s: float

    def __str__(self) -> str:
        return (
            f"{1e6 * self.median_s:.0f} us (median), {1e6 * self.most_s:.0f} us (99.99 %),"
            f" {1e6 * self.worst_s:.0f} us (worst)"
        )

    def report(self) -> TimesReport:
        """The same as plain data."""
        return {"median_s": self.median_s, "most_s": self.most_s, "worst_s": self.worst_s}


@dataclass(frozen=True, slots=True)
class RealtimeFigures:
    """How well the loop has kept time; `str()` is one line for people."""

    period_s: float
    cycles: int
    missed: int  # periods in which no tick began
    lost_s: float  # missed time that was not made up
    wake: Times  # how late ticks began
    work: Times  # what they took to compute
    worst_take_s: float  # to take what one handler has changed over

    def __str__(self) -> str:
        return (
            f"period {1e3 * self.period_s:g} ms: {self.cycles} cycles, {self.missed} missed"
            f" ({self.lost_s:.3g} s not made up); late by {self.wake}; computing {self.work}"
        )

    def report(self) -> LoopReport:
        """The same as plain data."""
        return {
            "period_s": self.period_s,
            "cycles": self.cycles,
            "missed": self.missed,
            "lost_s": self.lost_s,
            "late": self.wake.report(),
            "computing": self.work.report(),
        }


class RealtimeLoop:
    """Memory of the machine and the thread that lives it; UserError without the compiled core."""

    def __init__(
        self, trace: F64, silence_s: float, exchange: ExchangeMemory | None = None
    ) -> None:
        if not is_compiled:
            raise UserError("a real-time loop needs the compiled core (see docs/installation.md)")
        if not silence_s > 0.0:
            raise UserError(f"a silence of {silence_s:g} s: it has to be above 0")
        self.machine, self._spare = Memory(), Memory()
        self._trace = trace
        self._rows = whole(loop.H_ROWS)
        self._numbers = real(loop.N_ROWS)
        self._numbers[loop.SILENCE_S] = silence_s
        self._numbers[loop.GONE_S] = GONE_TIMES * silence_s
        self._numbers[loop.MADE_UP] = 1.0 if exchange is None else 0.0  # devices keep their time
        self._exchange = exchange or ExchangeMemory()
        self._entries = whole(ENTRY * MOST_ENTRIES)
        self._next = 0  # free entry
        self._codes = [(whole(CODE_WORDS), real(CODE_NUMBERS)) for _ in range(2)]
        self._code = 0  # buffer of the latest list that brought programs
        self._thread: threading.Thread | None = None

    def start(
        self, memory: Memory, code: tuple[I32, F64], prepare: Callable[[], None] = lambda: None
    ) -> None:
        """Begin to live with a state; `prepare` is called first, on the thread of the loop.

        What it raises is raised here, and nothing lives.
        """
        self.machine.replace(memory)
        self._rows[loop.CODE] = self._place(code) - 1

        is_ready = threading.Event()
        failures: list[Exception] = []

        def live() -> None:
            try:
                prepare()
            except Exception as failure:
                failures.append(failure)
                return
            finally:
                is_ready.set()
            machine, bus, (first, second) = self.machine, self._exchange, self._codes
            seen, log = whole(HEAP_BYTE_BASE // 4), whole(change_log_cy.HEAD)
            seen[quiet_cy.PAUSE] = 0  # every tick takes its time
            _realtime_run(
                machine.F, machine.I, machine.S, *first, *second, self._trace, seen, log,
                self._entries, self._entries.cast("B").cast("d"), self._spare.I, self._rows,
                self._numbers, bus.rows, bus.numbers, bus.out, bus.back,
            )  # fmt: skip

        self._thread = threading.Thread(target=live, name="real-time loop", daemon=True)
        self._thread.start()
        is_ready.wait()
        if failures:
            raise failures[0]

    @property
    def has_begun(self) -> bool:
        """Whether there was a beginning."""
        return self._thread is not None

    @property
    def is_alive(self) -> bool:
        """Whether the thread lives."""
        return self._thread is not None and self._thread.is_alive()

    def beat(self) -> None:
        """Python is there."""
        self._rows[loop.BEAT] = (self._rows[loop.BEAT] + 1) & loop.WRAP

    def asked(self) -> tuple[int, ...]:
        """How often each kind of work was wanted: requests, room, networks, devices."""
        return tuple(self._rows[loop.ASKED : loop.LISTS])

    @property
    def passed(self) -> int:
        """What the loop has passed over, bits as in `engine/realtime_cy.py`."""
        return self._rows[loop.PASSED]

    @property
    def untaken(self) -> int:
        """Lists that the loop has not taken yet."""
        return (self._rows[loop.GIVEN] - self._rows[loop.TAKEN]) & loop.WRAP

    def copy_to(self, memory: Memory) -> int:
        """Copy the state between two ticks; returns how many lists it is without."""
        while True:
            before = _realtime_sequence(self._rows)
            if before & 1 == 0 or not self.is_alive:
                memory.replace(self.machine)
                untaken = self.untaken
                if _realtime_sequence(self._rows) == before:
                    return untaken
            time.sleep(POLL_S)

    def give(self, changes: Changes, code: tuple[I32, F64] | None) -> None:
        """Let the loop take a list over, and programs that are valid with it."""
        words = changes.words()
        place = self._place(code)
        if self.untaken == 0 or self._next + len(changes) > MOST_ENTRIES:
            self._wait(0)
            self._next = 0
        self._entries[ENTRY * self._next : ENTRY * self._next + len(words)] = words
        self._post(self._next, len(changes), place)
        self._next += len(changes)

    def renew(self, memory: Memory, code: tuple[I32, F64]) -> None:
        """Replace the state as a whole, and wait until that is done."""
        place = self._place(code)
        self._spare.replace(memory)
        self._post(0, loop.WHOLE, place)
        self._wait(0)

    def end(self) -> None:
        """Bring all axes to rest and end the thread."""
        self._rows[loop.END] = 1
        if self._thread is not None:
            self._thread.join(REST_S)
            self._rows[loop.END] = loop.AT_ONCE
            self._thread.join(REST_S)

    def figures(self, period_s: float) -> RealtimeFigures:
        """The figures since they began at 0."""
        n = self._numbers
        return RealtimeFigures(
            period_s,
            int(n[loop.CYCLES]),
            int(n[loop.MISSED]),
            1e-9 * n[loop.LOST_NS],
            self._times(loop.WAKE, n[loop.WORST_WAKE_NS]),
            self._times(loop.WORK, n[loop.WORST_WORK_NS]),
            1e-9 * n[loop.WORST_TAKE_NS],
        )

    def begin_figures(self) -> None:
        """Let the figures, and the counters of the bus, begin at 0 with the next period."""
        self._rows[loop.FROM_ZERO] = (self._rows[loop.FROM_ZERO] + 1) & loop.WRAP

    def _times(self, first: int, worst_ns: float) -> Times:
        counts = self._numbers[first : first + loop.BINS].tolist()

        def below(part: float) -> float:
            wanted, seen = part * sum(counts), 0.0
            for place, count in enumerate(counts):
                seen += count
                if count and seen >= wanted:
                    return min(1e-9 * worst_ns, 1e-6 * (place + 1))
            return 0.0

        return Times(below(0.5), below(0.9999), 1e-9 * worst_ns)

    def _place(self, code: tuple[I32, F64] | None) -> int:
        """Put programs into the buffer that the loop does not use; which one it is, plus 1."""
        if code is None:
            return 0
        self._wait(0)  # from here on the loop uses the buffer of the latest list
        (words, numbers), (room, number_room) = code, self._codes[1 - self._code]
        if len(words) > len(room) or len(numbers) > len(number_room):
            raise UserError(
                f"the programs compile to {len(words)} words and {len(numbers)} numbers; the"
                f" real-time loop has room for {len(room)} and {len(number_room)}"
            )
        room[: len(words)], number_room[: len(numbers)] = words, numbers
        self._code = 1 - self._code
        return self._code + 1

    def _post(self, first: int, count: int, place: int) -> None:
        self._wait(loop.QUEUE - 1)
        k = loop.LISTS + loop.LIST_ROWS * (self._rows[loop.GIVEN] & (loop.QUEUE - 1))
        self._rows[k], self._rows[k + 1], self._rows[k + 2] = first, count, place
        _realtime_give(self._rows)

    def _wait(self, untaken: int) -> None:
        """Wait until no more lists than that are untaken; UserError once the loop has ended."""
        while self.untaken > untaken:
            if not self.is_alive:
                raise UserError("the real-time loop has ended")
            self.beat()
            time.sleep(POLL_S)
