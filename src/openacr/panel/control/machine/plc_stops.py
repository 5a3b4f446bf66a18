"""Breakpoints of PLCs: one is held after the scan in which a coil of its line has changed.

Held, its flag PLC Running is off: no scan follows, its outputs stay as they are. The flag alone
lets it go on, where RUN would begin it anew with the first scan and all preloads.
"""

from openacr.basic.memory.program_store import StoredLine
from openacr.controller import Controller
from openacr.debugger import rungs
from openacr.debugger.breakpoints import LineBreakpoint, watches_of
from openacr.debugger.calls import PROGRAMS, name_of
from openacr.debugger.conditions import Conditions
from openacr.engine.watches import Watch
from openacr.errors import UserError
from openacr.plc.instructions import FIRST_PLC_FLAG, FLAGS_PER_PLC

Coils = list[tuple[int, int, int]]  # PLC (16-23), line, flag


class PlcStops:
    """The lines of PLCs (16-23) after which they are held, and the PLCs that are."""

    def __init__(self, card: Controller, conditions: Conditions) -> None:
        self._card, self._conditions = card, conditions
        self.lines: dict[tuple[int, int], LineBreakpoint] = {}
        self._armed: Coils = []  # in the order of their watches
        self._held: dict[int, list[StoredLine]] = {}  # the texts that were scanned

    def set(self, plc: int, line: int, condition: str, most: int) -> None:
        """Hold a PLC after a change; UserError without a coil, or for more than `most` coils."""
        found = rungs.coils(self._card, plc, line)
        if not found:
            raise UserError(f"{name_of(plc)} line {line}: {rungs.NO_COIL}")
        others = [each for each in self._coils() if each[:2] != (plc, line)]
        if len(others) + len(found) > most:
            raise UserError(f"{most} coils of PLCs are watched at most: remove a breakpoint first")
        self.lines[plc, line] = LineBreakpoint(plc, line, condition)

    def _coils(self) -> Coils:
        return [
            (plc, line, flag)
            for plc, line in self.lines
            for flag in rungs.coils(self._card, plc, line)
        ]

    @property
    def is_stale(self) -> bool:
        """Whether a text has changed, and other coils are to be watched."""
        return bool(self.lines) and self._armed != self._coils()

    def watches(self) -> list[Watch]:
        """What the engine watches for the lines as they are now."""
        self._armed = self._coils()
        flags = [f"BIT{flag}" for _, _, flag in self._armed]
        return [watch for flag in flags for watch in watches_of(self._card, flag)]

    def hold(self, fired: list[int]) -> dict[int, int]:
        """Hold the PLCs whose watches have fired; their lines by PLC."""
        found: dict[int, int] = {}
        for plc, line in dict.fromkeys(self._armed[place][:2] for place in fired):
            if plc in found or not self._is_running(plc):
                continue
            if self._conditions.are_met(self.lines[plc, line], plc):
                self._put(plc, on=False)
                self._held[plc] = self._card.system.programs.lines(plc)
                found[plc] = line
        return found

    def is_held(self, plc: int) -> bool:
        """Whether a PLC is still held, with the text that was scanned."""
        is_same = self._held.get(plc) == self._card.system.programs.lines(plc)
        return plc in self._held and is_same and not self._is_running(plc)

    def go_on(self, plc: int) -> None:
        """Let a PLC scan on; UserError unless it is held."""
        if not self.is_held(plc):
            raise UserError(f"{name_of(plc)} is not held at a breakpoint: RUN starts it")
        del self._held[plc]
        self._put(plc, on=True)

    def _flag(self, plc: int) -> int:
        return FIRST_PLC_FLAG + FLAGS_PER_PLC * (plc - PROGRAMS)  # PLC Running

    def _is_running(self, plc: int) -> bool:
        return self._card.bit[self._flag(plc)]

    def _put(self, plc: int, *, on: bool) -> None:
        self._card.bit[self._flag(plc)] = on
