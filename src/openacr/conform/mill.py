"""A milling machine with AcroMill on the virtual card of a case."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from openacr.client import Card
from openacr.cnc.interpreter.interpreter import Interpreter
from openacr.cnc.interpreter.mdi import Mdi
from openacr.cnc.loading.load import load
from openacr.cnc.parts.library import begins_metric, part_named, prepared
from openacr.cnc.reading.findings import BlockError, Finding
from openacr.cnc.state.hosts import VirtualMachine
from openacr.conform import entries
from openacr.conform.form import NUMBER, DifferenceError
from openacr.conform.targets import POLL_TK, VirtualCard
from openacr.engine.watches import Watch, Watched
from openacr.errors import OpenacrError, UserError
from openacr.map.rows import axes as axis_rows
from openacr.map.words import mf1
from openacr.mill import zeroing
from openacr.mill.card.ballscrew import Table, computed, install, parse
from openacr.mill.config.overrides import Override
from openacr.mill.config.pparm import OperatorParameters
from openacr.mill.plan.estimate.checking import check_text
from openacr.mill.run.lifecycle import State
from openacr.mill.session import MillSession, Start
from openacr.sysvar import Store
from openacr.sysvar.lookup import one
from openacr.sysvar.tabs import AXIS, GENERAL, SPEEDS, TOOL
from openacr.sysvar.values import parsed

AXES = 3
FASTEST_UPM = 6000.0
LIMIT_S = 10.0  # for a state to be reached
PANEL = "panel"  # that holds the keys of jogs
STARTS = {
    "dry": "is_dry",
    "block": "is_single",
    "skipping": "is_skipping",
    "optional stop": "stops_optionally",
    "any tool": "accepts_tool",
}
TRACES = {"back": -1, "forward": 1, "stop": 0}
_START = re.compile(rf"line (\d+)|free at ({NUMBER})")
_JOG = re.compile(r"([A-Z])(?: (off)|([+-])([\d.]*)( fast)?(?: increment (\d))?)")


class Mill:
    """The store, the part program and, once something runs, the session on the card.

    Axes X Y Z that need not be homed, at most 6000 in/min; else the store is as new.
    """

    def __init__(self, card: VirtualCard) -> None:
        self._target = card
        self.store = self._set_up(Store())
        self.text, self.dialect = "", "acromill"
        self.tables: dict[int, Table] = {}  # of ballscrews, by axis
        self.made = ""  # the file of a table, of measurements
        self.heard: list[str] = []  # shown to the operator and not compared yet
        self.are_alarms_expected = False
        self.is_panel_there = True
        self.took_tk = 0  # in motion, by the latest block of MDI
        self._session: MillSession | None = None
        self._mdi: Mdi | None = None
        self._folder: TemporaryDirectory[str] | None = None  # of its files

    def _set_up(self, store: Store) -> Store:
        with store.transaction():
            for axis in range(AXES):
                store.write(AXIS.home_required[axis], 0)
            store.write(SPEEDS.max_machine_speed, FASTEST_UPM)
            store.write_text(GENERAL.card_model, self._target.world.model.name)
        return store

    def keep_on_disk(self) -> None:
        """Use a new store on disk, which outlives a restart, in place of the one in memory."""
        self.store.close()
        self.store = self._set_up(Store(self._place / "sysvar.db"))

    def restart(self) -> None:
        """End the front end and start it again, with what its store has kept."""
        path = self.store.path
        if path is None:
            raise UserError("`store on disk` has to come first: a store in memory is lost")
        self._leave()
        self.store = Store(path)

    def close(self) -> None:
        """Leave the card."""
        self._leave()
        if self._folder:
            self._folder.cleanup()

    def _leave(self) -> None:
        self._target.attend = None
        if self._session:
            with suppress(OpenacrError):  # the card of a case that failed may refuse it
                self._session.runner.bring_to_rest()
            self._session.close()
        self._session = self._mdi = None
        self.store.close()

    @property
    def _place(self) -> Path:
        """The folder of the files of this case, made when it is first needed."""
        if self._folder is None:
            self._folder = TemporaryDirectory()
        return Path(self._folder.name)

    # Without a machine.

    def put_file(self, name: str, text: str) -> None:
        """Put a file into the folder of the M codes of the user."""
        self.store.write_text(TOOL.custom_m_folder, str(self._place))
        (self._place / name).write_text(text, encoding="utf-8")

    @property
    def operator(self) -> OperatorParameters:
        """The variables of P PARM."""
        return OperatorParameters(self.store, self.session.card)

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

    def load_part(self, name: str, sizes: Mapping[int, float], d_number: int) -> None:
        """Load a library part with these sizes, in their own units; UserError or PartError."""
        is_metric = begins_metric(self.store)
        part = part_named(name)
        self.text = prepared(
            part, sizes, self.store, is_metric=is_metric, d_number=d_number
        ).program

    def table_of(self, letter: str, measurements: str, home_u: float) -> str:
        """The file of a ballscrew table that measurements become."""
        return computed(measurements, letter, home_u).text()

    # On the card.

    def load_table(self, letter: str, text: str) -> None:
        """Load the table of a ballscrew from the text of its file, beside those of other axes."""
        table, settings = parse(text, letter), self.session.runner.settings
        self.tables[settings.named(letter).index] = table
        install(self.session.card, settings, self.tables)

    @property
    def session(self) -> MillSession:
        """The session, set up when it is first needed, with the drives switched on."""
        if self._session is None:
            card = Card.open(self._target.world)
            self._session = MillSession(card, self.store, self.heard.append, is_virtual=False)
            names = " ".join(axis.name for axis in self._session.runner.settings.axes)
            card.command(f"DRIVE ON {names}", program=self._session.machine.master)
            self._target.attend = self._poll
        return self._session

    def _poll(self) -> None:
        self.session.poll()
        if self.is_panel_there:
            self.session.runner.controls.renew(PANEL)

    @property
    def state(self) -> State:
        """The state of the machine."""
        return self.session.runner.state

    def start(self, options: str = "") -> None:
        """Start the part program: `dry`, `block`, `skipping`, `line 5`, `free at 2` ..."""
        program = load(self.text, self.store, self.dialect)
        if program.errors:
            raise UserError("; ".join(map(str, program.errors)))
        chosen: dict[str, Any] = {"dialect": self.dialect}
        for option in filter(None, options.split(", ")):
            if match := _START.fullmatch(option):
                chosen |= {"line": int(match[1])} if match[1] else {"safe_z": float(match[2])}
            elif option in STARTS:
                chosen[STARTS[option]] = True
            else:
                known = ", ".join([*STARTS, "line 5", "free at 2"])
                raise UserError(f"{option}: a program starts with {known}")
        self.session.start(program, Start(**chosen))

    def _go_on(self) -> None:
        """START: where the program holds, else from its first line."""
        if self.state is State.IDLE and self.text:
            self.start()
        else:
            self.session.runner.start()

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
            for let_pass in (self._poll, self._advance):
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
        return Watch(Watched.WORD, mf1.word[self.session.machine.master], mf1.IN_MOTION)

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
            "START": self._go_on,
            "STOP": runner.stop,
            "RESUME": runner.resume,
            "ABORT": runner.abort,
            "ACKNOWLEDGE": runner.acknowledge,
            "CONFIRM": runner.entry_actions.changer.confirm,
        }
        buttons[button]()

    def switch(self, name: str, click: int) -> None:
        """Turn the switch of an override (FOV, ROV, SOV) to a click."""
        by_tab = dict(zip(("FOV", "ROV", "SOV"), Override, strict=True))
        if name not in by_tab:
            raise UserError(f"{name}: the overrides are {', '.join(by_tab)}")
        self.session.runner.overrides.choose(by_tab[name], click)

    def jog(self, text: str) -> None:
        """Hold or release a key (`X+`, `X- fast`, `X off`), or jog by a distance or increment."""
        match = _JOG.fullmatch(text)
        if match is None:
            raise UserError(f"{text}: jogs are X+, X- fast, X off, X+0.5, X- increment 3")
        name, is_off, sign, distance, fast, preset = match.groups()
        runner = self.session.runner
        axis = runner.settings.named(name).index
        direction, is_fast = (-1 if sign == "-" else 1), bool(fast)
        if is_off:
            runner.controls.release(PANEL, axis)
        elif preset:
            runner.jog(lambda jog: jog.increment(axis, direction, int(preset), fast=is_fast))
        elif distance:
            runner.jog(lambda jog: jog.move(axis, direction * float(distance), fast=is_fast))
        else:
            runner.controls.press(PANEL, axis, direction, fast=is_fast)

    def home(self, names: str) -> None:
        """Begin to home the axes named, or all."""
        self.session.runner.home(self._axes(names))

    def turn(self, names: str) -> None:
        """Connect the hand wheel to axes, or to none."""
        self.session.runner.turn(self._axes(names) if names else [])

    def zero(self, words: str) -> None:
        """Set the floating zero so that axes read 0 (`X`) or a value (`X5`); `` is all."""
        values = {word[0]: float(word[1:] or 0.0) for word in words.split()}
        axes = self.session.runner.settings
        zeroing.preset(
            self.session, {axes.named(name).index: value for name, value in values.items()}
        )

    def clear_zero(self) -> None:
        """Clear the floating zero of all axes."""
        zeroing.clear_all(self.session)

    def go_to_zero(self, names: str) -> None:
        """Move axes, or all, to program 0."""
        for block in zeroing.goto_blocks(self.session, self._axes(names)):
            if refusals := self.type(block):
                raise UserError("; ".join(refusals))

    def reading(self) -> dict[str, float]:
        """What each axis reads: its position in the program's coordinates, in default units."""
        place = zeroing.reader(self.session).position
        return {axis.name: place[axis.index] for axis in self.session.runner.settings.axes}

    def _axes(self, names: str) -> list[int]:
        settings = self.session.runner.settings
        return [settings.named(name).index for name in names.split() or settings.names()]

    def trace(self, direction: str) -> None:
        """Trace the path of a pause `back` or `forward`, or `stop`."""
        if direction not in TRACES:
            raise UserError(f"{direction}: a path is traced {', '.join(TRACES)}")
        self.session.runner.trace(TRACES[direction])

    def lose(self, what: str) -> None:
        """The panel that holds keys, or the whole host, is not heard any more."""
        if what == "host":
            self._target.attend = None
        self.is_panel_there = False

    def type(self, block: str) -> list[str]:
        """Run a block of MDI to its end (`took_tk` is its motion); why it was refused."""
        if self._mdi is None:
            self._mdi = self.session.mdi(self.dialect)
        try:
            self.session.start_block(self._mdi, block)
        except BlockError as error:
            return [f"{error.finding.code} {error.finding.text}"]
        except UserError as error:
            return [str(error)]
        self.took_tk = self.wait_for(State.IDLE.name)
        return []

    def alarms(self) -> list[str]:
        """The active alarms, oldest first, with their codes."""
        if self._session is None:
            return []
        return [f"{each.kind.code} {each.text}" for each in self._session.runner.alarms.active]

    def place(self) -> tuple[dict[str, int], dict[str, float]]:
        """Where each axis is commanded to be [pulses], and its pulses a unit."""
        rows = {
            axis.name: axis_rows.current_position[axis.index]
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
