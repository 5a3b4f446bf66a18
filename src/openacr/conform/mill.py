"""A milling machine with AcroMill on the virtual card of a case."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

from openacr.client import Card
from openacr.cnc.interpreter.interpreter import Interpreter
from openacr.cnc.interpreter.mdi import Mdi
from openacr.cnc.loading.load import load
from openacr.cnc.reading.findings import BlockError, Finding
from openacr.cnc.state.hosts import VirtualMachine
from openacr.conform import entries
from openacr.conform.form import DifferenceError
from openacr.conform.targets import POLL_TK, VirtualCard
from openacr.engine.watches import Watch, Watched
from openacr.errors import UserError
from openacr.map import numbers as n
from openacr.mill.plan.checking import check_text
from openacr.mill.run.lifecycle import State
from openacr.mill.session import MillSession, Start
from openacr.sysvar import Store
from openacr.sysvar.lookup import one
from openacr.sysvar.tabs import AXIS, SPEEDS
from openacr.sysvar.values import parsed

AXES = 3
FASTEST_UPM = 6000.0
LIMIT_S = 10.0  # for a state to be reached


class Mill:
    """The store, the part program and, once something runs, the session on the card.

    Axes X Y Z that need not be homed, at most 6000 in/min; else the store is as new.
    """

    def __init__(self, card: VirtualCard) -> None:
        self._target = card
        self.store = Store()
        with self.store.transaction():
            for axis in range(AXES):
                self.store.write(AXIS.home_required[axis], 0)
            self.store.write(SPEEDS.max_machine_speed, FASTEST_UPM)
        self.text, self.dialect = "", "acromill"
        self.heard: list[str] = []  # shown to the operator and not compared yet
        self.are_alarms_expected = False
        self._session: MillSession | None = None
        self._mdi: Mdi | None = None

    def close(self) -> None:
        """Leave the card."""
        self._target.attend = None
        if self._session:
            self._session.close()
        self.store.close()

    # Without a machine.

    def write(self, name: str, text: str) -> None:
        """Set a cell, by its number or name, to a value as users write it."""
        cell = one(name)
        value = parsed(cell, text, self.store.is_metric, self.store.letter_of(cell))
        if isinstance(value, str):
            self.store.write_text(cell.number, value)
        else:
            self.store.write(cell.number, value)

    def value(self, name: str) -> float | str:
        """The value of a cell."""
        return self.store.value(one(name).number)

    def messages(self, text: str) -> list[Finding]:
        """What `openacr mill check` finds in a text."""
        return check_text(text, Path("PART.TXT"), self.store, self.dialect)

    def entries(self) -> Iterator[str]:
        """What the program becomes, without a machine, or its errors; the last may be one, too."""
        program = load(self.text, self.store, self.dialect)
        yield from map(_placed, program.errors)
        if program.errors:
            return
        run = Interpreter(program, self.store, VirtualMachine(), self.dialect)
        try:
            yield from entries.texts(run.entries())
        except BlockError as error:
            yield _placed(error.finding)

    # On the card.

    @property
    def session(self) -> MillSession:
        """The session, set up when it is first needed, with the drives switched on."""
        if self._session is None:
            card = Card.open(self._target.world)
            self._session = MillSession(card, self.store, self.heard.append, is_virtual=False)
            names = " ".join(axis.name for axis in self._session.runner.settings.axes)
            card.command(f"DRIVE ON {names}", program=self._session.machine.master)
            self._target.attend = self._session.poll
        return self._session

    @property
    def state(self) -> State:
        """The state of the machine."""
        return self.session.runner.state

    def start(self) -> None:
        """Start the part program, or go on where it holds."""
        if self.state is not State.IDLE:
            self.session.runner.start()
            return
        program = load(self.text, self.store, self.dialect)
        if program.errors:
            raise UserError("; ".join(map(str, program.errors)))
        self.session.start(program, Start(dialect=self.dialect))

    def wait_for(self, name: str) -> int:
        """Let time pass until a state (IDLE, HOLD ...) is reached; the periods of motion meanwhile.

        Counted from the first to the last of them.
        """
        state = State[name]
        runner, card = self.session.runner, self._target.world
        last_tk = card.lived_tk + round(LIMIT_S / card.period_s)
        begun_tk: int | None = None
        ended_tk = card.lived_tk
        was_moving = False
        while runner.state is not state or self._is_ending():
            if card.lived_tk >= last_tk or self._is_stuck(state):
                raise DifferenceError(state.name, self.shown_state())
            for let_pass in (self.session.poll, self._advance):
                let_pass()
                is_moving = bool(card.memory.I[self._motion.row] & self._motion.mask)
                if is_moving and begun_tk is None:
                    begun_tk = card.lived_tk
                elif was_moving and not is_moving:
                    ended_tk = card.lived_tk
                was_moving = is_moving
        return 0 if begun_tk is None else ended_tk - begun_tk

    @property
    def _motion(self) -> Watch:
        return Watch(Watched.WORD, n.MF1_WORD + self.session.machine.master, n.MF1_IN_MOTION)

    def _advance(self) -> None:
        """Let time pass until the next poll, or until motion begins or ends."""
        card = self._target.world
        card.watch([self._motion])
        card.advance(POLL_TK)
        card.watch()

    def _is_ending(self) -> bool:
        runner = self.session.runner
        return runner.state in (State.IDLE, State.ALARM) and runner.is_busy

    def _is_stuck(self, wanted: State) -> bool:
        """Whether the end of a program is waited for that an alarm or stop has ended before."""
        stops = (State.HOLD, State.PAUSED, State.ALARM)
        return wanted is State.IDLE and self.state in stops and not self._is_ending()

    def shown_state(self) -> str:
        """The state, the reason of a hold or wait, and the alarms."""
        runner = self.session.runner
        return " ".join(each for each in (runner.state.name, runner.reason, *self.alarms()) if each)

    def press(self, button: str) -> None:
        """Press a button of the front end."""
        runner = self.session.runner
        buttons: dict[str, Callable[[], object]] = {
            "START": self.start,
            "STOP": runner.stop,
            "RESUME": runner.resume,
            "ABORT": runner.abort,
            "ACKNOWLEDGE": runner.acknowledge,
        }
        buttons[button]()

    def type(self, block: str) -> list[str]:
        """Run a block of MDI to its end; the errors it was refused with."""
        if self._mdi is None:
            self._mdi = self.session.mdi(self.dialect)
        try:
            self.session.start_block(self._mdi, block)
        except BlockError as error:
            return [f"{error.finding.code} {error.finding.text}"]
        except UserError as error:
            return [str(error)]
        self.wait_for(State.IDLE.name)
        return []

    def alarms(self) -> list[str]:
        """The active alarms, oldest first, with their codes."""
        if self._session is None:
            return []
        return [f"{each.kind.code} {each.text}" for each in self._session.runner.alarms.active]

    def place(self) -> tuple[dict[str, int], dict[str, float]]:
        """Where each axis is commanded to be [pulses], and its pulses a unit."""
        rows = {
            axis.name: n.AX_BASE + axis.index * n.AX_STRIDE + n.AX_CURRENT_POSITION
            for axis in self.session.runner.settings.axes
        }
        places = {name: int(self._target.world.p[row]) for name, row in rows.items()}
        per_unit = {
            axis.name: self.store.read(AXIS.pulses_per_unit[axis.index])
            for axis in self.session.runner.settings.axes
        }
        return places, per_unit


def _placed(finding: Finding) -> str:
    return f"line {finding.line}: {finding.code} {finding.text}"
