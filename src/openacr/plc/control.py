"""Start and halt PLCs."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from openacr.map.memory import Memory
from openacr.map.rows import plc_counters, plc_timers, plcs
from openacr.map.words import plf
from openacr.plc import scan_cy as scan
from openacr.plc.compile import Compiled, Preload, compile_plc
from openacr.plc.instructions import Operand
from openacr.plc.reader import PlcLine

Text = Iterable[tuple[int, PlcLine]]

_PRELOAD_ROWS = {
    Operand.TIMER: plc_timers.timer_preload,
    Operand.COUNTER: plc_counters.counter_preload,
}
_FIRST = plf.PLC_RUNNING | plf.FIRST_SCAN


class Plcs:
    """The PLCs of a card; `text` gives the stored lines of one, with their numbers.

    The run state of a PLC is its flag and its code is in hidden rows, so a snapshot of the
    memory holds all of it.
    """

    def __init__(self, memory: Memory, text: Callable[[int], Text]) -> None:
        self._memory = memory
        self._text = text

    def is_running(self, plc: int) -> bool:
        """Whether a PLC is running."""
        return bool(self._memory.I[plf.word[plc]] & plf.PLC_RUNNING)

    def run(self, plc: int) -> None:
        """Start a PLC (RUN); first scan in the next servo interrupt, CardError if impossible."""
        compiled = compile_plc(self._text(plc))
        self._write_code(plc, compiled)
        for preload in compiled.preloads:
            self._write_preload(preload)
        self._memory.I[plcs.tick_count[plc]] = 1
        self._memory.I[plf.word[plc]] |= _FIRST

    def halt(self, plc: int) -> None:
        """Stop a PLC (HALT); outputs stay as they are."""
        self._memory.I[plf.word[plc]] &= ~_FIRST

    def note(self, plc: int, on: bool) -> None:
        """Have the scans of a PLC note in its code what they see, or no longer."""
        self._memory.I[plcs.noted[plc]] = on
        for k in self._places(plc):
            self._memory.I[k] &= ~scan.SEEN

    def seen(self, plc: int) -> list[int]:
        """What each instruction has seen while scans were noted: bits of `scan_cy.SEEN`."""
        return [int(self._memory.I[k]) & scan.SEEN for k in self._places(plc)]

    def code(self, plc: int) -> list[int]:
        """The instructions that are scanned, as `Compiled.words`."""
        return [int(self._memory.I[k]) & ~scan.SEEN for k in self._places(plc)]

    def _places(self, plc: int) -> range:
        first = plcs.code[plc]
        return range(first, first + self._memory.I[plcs.length[plc]])

    def _write_code(self, plc: int, compiled: Compiled) -> None:
        for place, word in enumerate(compiled.words):
            self._memory.I[plcs.code[plc] + place] = word
        self._memory.I[plcs.length[plc]] = len(compiled.words)

    def _write_preload(self, preload: Preload) -> None:
        self._memory.I[_PRELOAD_ROWS[preload.operand][preload.number]] = preload.value
