"""Start, stop, hold and step programs, by command and by their request flags.

Pause and block mode follow the same law: the rising edge of the control flag asks the
master of the program for a feedhold; once the path rests (at once without motion) the mode
flag is set, and the program stops before its next line.
"""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING, Protocol

from msgspec import Struct

from openacr.basic.memory.program_memory import PROGRAMS
from openacr.errors import CardError
from openacr.map.rows import plcs as plc_rows
from openacr.map.words import mf1, pf, plf
from openacr.messages import NOT_SUPPORTED
from openacr.motion.interlocks import master_moving
from openacr.motion.path import moves

if TYPE_CHECKING:
    from openacr.basic.execute.executor import Executor
    from openacr.basic.execute.system import System


class Plcs(Protocol):
    """Who runs the PLCs, by their number."""

    def is_running(self, plc: int) -> bool:
        """Whether it is scanned."""

    def run(self, plc: int) -> None:
        """RUN."""

    def halt(self, plc: int) -> None:
        """HALT: outputs stay."""


class _Hold(Struct, frozen=True):
    """The flags of pause or block mode."""

    control: int
    edge: int
    mode: int
    waiting: int
    entered: int = 0  # set together with the mode


PAUSE = _Hold(pf.PAUSE_CONTROL, pf.PAUSE_EDGE_DETECT, pf.PAUSE_MODE, pf.PAUSE_MODE_WAITING)
BLOCK = _Hold(
    pf.BLOCK_CONTROL, pf.BLOCK_EDGE_DETECT, pf.BLOCK_MODE, pf.BLOCK_MODE_WAITING,
    pf.STEP_FIRST_BLOCK,
)  # fmt: skip


class ProgramControl:
    """Programs 0 to 15 and PLCs 16 to 23, as RUN, HALT, PAUSE and their kin see them."""

    def __init__(self, system: System, executor: Executor, plcs: Plcs | None = None) -> None:
        self._system = system
        self._executor = executor
        self._plcs = plcs
        self._card = system.card

    def is_running(self, owner: int) -> bool:
        """Whether it executes, waits or is held."""
        if owner < PROGRAMS:
            return self._executor.is_running(owner)
        return self._plcs is not None and self._plcs.is_running(owner - PROGRAMS)

    def run(self, owner: int, line: int | None = None) -> None:
        """RUN: begin at the first line or at `line`."""
        if owner < PROGRAMS:
            self._executor.run_program(owner, line)
        elif self._plcs is None:
            raise CardError(NOT_SUPPORTED)
        else:
            self._system.listeners.plc_changes(owner - PROGRAMS)
            self._plcs.run(owner - PROGRAMS)

    def halt(self, owner: int) -> None:
        """HALT: end a program and slow the coordinated motion of its master to rest."""
        if owner >= PROGRAMS:
            if self._plcs is not None:
                self._plcs.halt(owner - PROGRAMS)
            return
        self._executor.halt_program(owner)
        master = self._master(owner)
        if master is not None:
            moves.halt(self._card, master)

    def pause(self, owner: int) -> None:
        """PAUSE; PLCs know no pause."""
        self._command(owner, set_=pf.PAUSE_CONTROL)

    def resume(self, owner: int) -> None:
        """RESUME."""
        self._command(owner, clear=pf.PAUSE_CONTROL)

    def block(self, owner: int) -> None:
        """BLK."""
        self._command(owner, set_=pf.BLOCK_CONTROL)

    def auto(self, owner: int) -> None:
        """AUT: no effect outside block mode."""
        self._command(owner, clear=pf.BLOCK_CONTROL)

    def step(self, owner: int) -> None:
        """STEP: one line, and one move, in block mode; no effect outside."""
        if owner < PROGRAMS and self._flags(owner) & pf.BLOCK_MODE:
            self._change(owner, set_=pf.STEP_REQUEST_FLAG, clear=pf.STEP_FIRST_BLOCK)
            master = self._master(owner)
            if master is not None:
                moves.step(self._card, master)

    def trace(self, owner: int, on: bool) -> None:
        """TRON and TROFF."""
        if owner < PROGRAMS:
            flag = pf.TRACE_MODE_ENABLE
            self._change(owner, set_=flag if on else 0, clear=flag)

    # flags

    def scan(self) -> None:
        """Serve the request and control flags of all programs and PLCs: part of the slow scan."""
        for program in range(PROGRAMS):
            if self._flags(program):
                self._scan_program(program)
        for plc in range(plc_rows.COUNT):
            self._scan_plc(plc)

    def _scan_plc(self, plc: int) -> None:
        """A PLC that cannot run stays halted; there is no channel to tell."""
        word = plf.word[plc]
        flags = self._card.memory.I[word]
        self._card.memory.I[word] = flags & ~(plf.RUN_REQUEST | plf.HALT_REQUEST)
        if flags & plf.HALT_REQUEST:
            self.halt(PROGRAMS + plc)
        if flags & plf.RUN_REQUEST and not self.is_running(PROGRAMS + plc):
            with suppress(CardError):
                self.run(PROGRAMS + plc)

    def _scan_program(self, program: int) -> None:
        flags = self._flags(program)
        if flags & pf.HALT_REQUEST_FLAG:
            self._change(program, clear=pf.HALT_REQUEST_FLAG)
            self.halt(program)
        if flags & pf.RUN_REQUEST_FLAG:
            self._change(program, clear=pf.RUN_REQUEST_FLAG)
            if not self.is_running(program):
                self.run(program)
        self._scan_step(program)
        for hold in (BLOCK, PAUSE):
            self._scan_hold(program, hold)

    def _scan_step(self, program: int) -> None:
        """The rising edge of Step Control is a step."""
        flags = self._flags(program)
        is_set = bool(flags & pf.STEP_CONTROL)
        if is_set and not flags & pf.STEP_EDGE_DETECT:
            self.step(program)
        edge = pf.STEP_EDGE_DETECT
        self._change(program, set_=edge if is_set else 0, clear=edge)

    def _scan_hold(self, program: int, hold: _Hold) -> None:
        flags = self._flags(program)
        if flags & hold.control:
            self._hold(program, hold)
        elif flags & (hold.edge | hold.mode):
            self._release(program, hold)

    def _hold(self, program: int, hold: _Hold) -> None:
        """The control flag is set: feedhold at its edge, the mode once the path rests."""
        flags = self._flags(program)
        master = self._master(program)
        is_moving = master is not None and master_moving(self._card, master)
        if is_moving and not flags & hold.edge:
            moves.hold(self._card, master)  # type: ignore[arg-type]
        self._change(program, set_=hold.edge)
        if not flags & hold.mode and (not is_moving or self._is_held(master)):
            self._change(program, set_=hold.mode | hold.entered)

    def _release(self, program: int, hold: _Hold) -> None:
        """The control flag is clear again: end the mode, cycle start."""
        self._change(program, clear=hold.edge | hold.mode | hold.waiting)
        master = self._master(program)
        if master is not None:
            if hold is BLOCK:
                moves.end_steps(self._card, master)
            moves.release(self._card, master)

    def _is_held(self, master: int | None) -> bool:
        if master is None:
            return False
        return bool(self._card.memory.I[mf1.word[master]] & mf1.IN_FEEDHOLD)

    def _command(self, owner: int, *, set_: int = 0, clear: int = 0) -> None:
        """A command is the flag, noticed at once."""
        if owner < PROGRAMS:
            self._change(owner, set_=set_, clear=clear)
            self._scan_program(owner)

    def _master(self, program: int) -> int | None:
        return self._card.attachments.master(program)

    def _flags(self, program: int) -> int:
        return self._card.memory.I[pf.word[program]]

    def _change(self, program: int, *, set_: int = 0, clear: int = 0) -> None:
        word = pf.word[program]
        self._card.memory.I[word] = self._card.memory.I[word] & ~clear | set_
