"""Machine session: the card, the cells, the runner and the watchdog of one run.

The virtual machine is homed and has nothing wired to it: inputs configured in the store are
ignored, waits for relays are skipped, requested tools are loaded at once. A real machine has
everything configured in the store.
"""

import math
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from itertools import chain, islice, repeat
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from openacr.client import Card
from openacr.client.links import Host
from openacr.client.options import Options as Talking
from openacr.cnc import canonical as c
from openacr.cnc.interpreter.interpreter import Interpreter
from openacr.cnc.interpreter.interpreter import Options as Reading
from openacr.cnc.interpreter.mdi import Mdi
from openacr.cnc.interpreter.replay import Rehearsal, Replay, rehearsal, start_at
from openacr.cnc.loading.load import load_blank
from openacr.cnc.program.program import Node, Program
from openacr.cnc.state.hosts import Cells
from openacr.cnc.state.shadow import Shadow
from openacr.engine.watches import Watch, Watched
from openacr.errors import UserError
from openacr.map.words import mf1
from openacr.mill.card import alarms, homed, soft_limits
from openacr.mill.card.alarms import Alarms
from openacr.mill.card.ballscrew import tables_of
from openacr.mill.card.checks import check_axes, check_firmware, check_rest
from openacr.mill.card.driver import LINK_ERRORS, MachineDriver
from openacr.mill.card.enabling import rest_outputs
from openacr.mill.card.leftovers import has_tripped, tidy
from openacr.mill.card.messages import Message, Messages, definitions
from openacr.mill.card.owner import BEAT_S, LISTEN_S, Owner
from openacr.mill.card.setup import MOVES, prepare, user_variables
from openacr.mill.card.watchdog import NO_WATCHDOG, Watchdog
from openacr.mill.config.curves import can_plan
from openacr.mill.config.folders import folders_of
from openacr.mill.config.settings import HOMED, NONE, Settings
from openacr.mill.manual.jogging import Jogging
from openacr.mill.plan.curves.curve_limits import moves_needed
from openacr.mill.run.dripping import Drip
from openacr.mill.run.lifecycle import Options, State
from openacr.mill.run.run_host import RunHost
from openacr.mill.run.runner import Runner
from openacr.sysvar import AT_START, Store
from openacr.sysvar.rules import require_wiring
from openacr.sysvar.tabs import CONTROL, FOV, GENERAL, IO, ROV, SOV, SPINDLE, TOOL

if TYPE_CHECKING:
    from openacr.controller import Controller

POLL_S = 0.02
SHORTEST_S = 0.001  # the clock of the card counts milliseconds
MOTION = mf1.IN_MOTION | mf1.MOVE_BUFFERED | mf1.NOT_IN_POSITION
ALL_AXES = 255
# Inputs of the store that are not wired on the virtual machine.
UNWIRED = (
    IO.block_skip,
    IO.optional_stop,
    IO.feedhold_input,
    IO.cycle_start_input,
    IO.emergency_stop,
    IO.soft_limits_input,
    IO.jog_joystick_input,
    IO.lubrication_error,
    FOV.switch,
    ROV.switch,
    SOV.switch,
    SPINDLE.at_zero_input,
    SPINDLE.at_speed_input,
    SPINDLE.exception_input,
    SPINDLE.oriented_input,
    TOOL.changed_input,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Start:
    """Options for starting a program."""

    dialect: str = "acromill"
    line: int = 1
    is_dry: bool = False
    is_single: bool = False  # stop after every block
    is_skipping: bool = False
    stops_optionally: bool = False
    is_repeated: bool = True  # if Repeat Forever is set in the store
    accepts_tool: bool = False  # start at a line although another tool is in the spindle
    safe_z: float | None = None  # machine position of Z where the tool is free, for a start line


class Reader(Protocol):
    """Follows the reading of a program, block by block."""

    def cells(self, cells: Cells) -> Cells:
        """The cells that the program is given."""

    def begin(self, run: Interpreter) -> None:
        """The interpreter that will read it."""

    def attend(self, node: Node) -> None:
        """Called before a block acts, ahead of the machine."""


class MillSession:
    """A card set up for the machine, with its runner."""

    def __init__(
        self,
        card: Card,
        cells: Cells,
        say: Callable[[str], None],
        *,
        is_virtual: bool,
        folder: Path | None = None,  # of the store, for its files
        owner: Owner | None = None,
        is_set_up: bool = True,
    ) -> None:
        self._owner = owner
        self.is_set_up = is_set_up  # else the card is only read: nothing runs, jogs or homes
        self._folder = folder
        self.cells = cells
        self.card = card
        self.is_virtual = is_virtual
        self.virtual_card: Controller | None = None
        self.program: Program | None = None
        self.typed: list[str] = []  # blocks run in MDI: the text of a program
        self.reader: Reader | None = None  # follows programs that are started
        self.reading: Interpreter | None = None  # of the last program, or of MDI
        settings = Settings(cells)
        depth, tables = MOVES, {}
        self._limits_found: list[str] = []
        if is_set_up:
            with cells.transaction():
                for number, value in AT_START.items():
                    cells.write(number, value)
            self._limits_found = [] if is_virtual else soft_limits.found(card, settings)
            tables = tables_of(cells, settings, folder)
            moves = MOVES
            if can_plan(settings) and not is_virtual:
                moves = max(moves, moves_needed(settings))
            depth = prepare(card, settings, tables, has_extensions=is_virtual, moves=moves)
        axes = [axis.index for axis in settings.axes]
        self.machine = MachineDriver(card, axes, settings.master, rounds_corners=is_virtual)
        alarm_list = Alarms(None if is_virtual else _error_log(cells, folder))
        self.motion = Watch(Watched.WORD, mf1.word[self.machine.master], MOTION)
        self.runner = Runner(
            self.machine, cells, depth, say, alarm_list, has_operator=not is_virtual,
            compensated=tables,
        )  # fmt: skip
        self._drip: Drip | None = None
        self.show_message: Callable[[Message, bool], None] = partial(_say_message, say)
        io = self.runner.io
        if is_set_up:
            rest_outputs(io)
        defined = [
            each for each in definitions(cells) if not (is_virtual and io.has_input(each.bit))
        ]
        self.messages = Messages(io, defined, self._note_message)
        self._watchdog: Watchdog | None = None
        if owner is not None:
            self._guard(say)

    def _guard(self, say: Callable[[str], None]) -> None:
        """Install the watchdog on the card, unless the store disables it."""
        if self.runner.settings.watchdog_program == NONE:
            say(NO_WATCHDOG)
            return
        self._watchdog = Watchdog(self.card, self.runner.io)
        self._watchdog.install()
        self.machine.watch_program(self._watchdog.program)
        self.runner.guard(self._watchdog.rearm)

    @classmethod
    def virtual(cls, store: Store, say: Callable[[str], None] = print) -> "MillSession":
        """Create a virtual machine; a program's changes to the store are discarded."""
        from openacr.controller import Controller

        cells = Shadow(store)
        cells.write(HOMED, ALL_AXES)
        for cell in UNWIRED:
            cells.write(cell, NONE)
        cells.write(SPINDLE.code, int(store.read(SPINDLE.code)) & 1)  # no handshake, same range
        controller = Controller(store.read_text(GENERAL.card_model))
        check_axes(controller.model, Settings(cells))
        card = Card.open(controller)
        shop = cls(card, cells, say, is_virtual=True, folder=_folder_of(store))
        shop.virtual_card = controller
        names = " ".join(axis.name for axis in shop.runner.settings.axes)
        shop.card.command(f"DRIVE ON {names}", program=shop.machine.master)
        return shop

    @classmethod
    def real(
        cls, target: str | Host, store: Store, say: Callable[[str], None] = print
    ) -> "MillSession":
        """Open a real card over a link; drives are left as they are."""
        timeout_s = Settings(store).link_timeout_s
        card = Card.open(target, Talking(timeout_s=timeout_s, reconnect_s=timeout_s))
        return cls.on(card, store, say)

    @classmethod
    def on(cls, card: Card, store: Store, say: Callable[[str], None]) -> "MillSession":
        """Set a connected card up for the machine; refused, its connection is closed."""
        settings = Settings(store)
        try:
            require_wiring(store)
            check_firmware(card)
            user_variables(card)
            listen_s = max(LISTEN_S, settings.link_timeout_s + BEAT_S)
            owner = Owner(card, store.path, program=settings.master, listen_s=listen_s)
        except BaseException:
            card.close()
            raise
        try:
            tidy(card, settings, say, was_left=bool(owner.found))
            check_rest(card, settings)
            homed.agree(card, store, say)  # before the set-up: tables act only on homed axes
            return cls(card, store, say, is_virtual=False, folder=_folder_of(store), owner=owner)
        except BaseException:
            with suppress(*LINK_ERRORS):
                owner.release(left=owner.found)  # the value that an installed watchdog still polls
            card.close()
            raise

    @classmethod
    def bare(cls, card: Card, store: Store, say: Callable[[str], None]) -> "MillSession":
        """A connected card as it is: nothing is set up or claimed, and the machine cannot run."""
        return cls(card, store, say, is_virtual=False, folder=_folder_of(store), is_set_up=False)

    def close(self) -> None:
        """Close the link and release the machine."""
        if self._drip is not None:
            self._drip.close()  # the program source first
        if self._owner is not None:
            self._release(self._owner)
        self.card.close()

    def _release(self, owner: Owner) -> None:
        """Remove the watchdog, unless it has stopped the machine, and give up ownership."""
        if self.runner.is_out_of_reach:
            owner.forget()
            return
        with suppress(*LINK_ERRORS):
            if self._watchdog is not None and owner.is_ours() and not has_tripped(self.card):
                self._watchdog.remove()
            if owner.is_ours():
                soft_limits.restore(self.card, self.runner.settings, self._limits_found)
            owner.release()

    def hand_over(self) -> None:
        """Leave the card to others as it is, at rest; what was set up is not in use any more."""
        if self.runner.is_busy:
            raise UserError(f"the machine is in use: the state is {self.runner.state.name}")
        if self._owner is not None:
            self._release(self._owner)
        self._owner = self._watchdog = None
        self.machine.watch_program(None)
        self.is_set_up = False

    @property
    def cells_unit(self) -> str:
        """The unit of the store, in which positions are."""
        return "mm" if self.cells.read(CONTROL.default_units) else "inch"

    # --- programs ---------------------------------------------------------------------

    @property
    def block(self) -> tuple[int, str] | None:
        """Line and text of the executing block; None if nothing runs."""
        source = self.runner.source
        if source is None:
            return None
        text = self.program.text_of(source) if self.program else source.text
        return source.line, text.strip()

    def rehearse(self, program: Program, start: Start) -> Replay:
        """Replay the lines before a start line: nothing moves, nothing is written."""
        return start_at(self._interpreter(program, start), start.line, start.safe_z)

    def rehearsal(self, program: Program, start: Start) -> Rehearsal:
        """The same step by step: a long program takes its time."""
        return rehearsal(self._interpreter(program, start), start.line, start.safe_z)

    def start(self, program: Program, start: Start, replay: Replay | None = None) -> None:
        """Start a program; at a later line after its replay, which the operator has accepted."""
        self.program = program
        options = Options(
            is_dry=start.is_dry,
            is_single=start.is_single,
            stops_optionally=start.stops_optionally,
            is_repeated=start.is_repeated,
        )
        if start.line > 1 and replay is None:
            replay = self.rehearse(program, start)
        if replay is not None and replay.needs_tool and not start.accepts_tool:
            raise UserError("another tool is in the spindle; --any-tool starts anyway")
        reading = replay.run if replay is not None else self._interpreter(program, start)
        self.reading = reading
        first: Callable[[], Iterator[c.Entry]] = replay.entries if replay else reading.entries
        passes = chain([first], repeat(reading.entries))
        self.runner.run(lambda _host: self._watched(next(passes)()), options)

    def keep_drip(self, drip: Drip) -> None:
        """Close this serial line when the machine is at rest, at the latest with the session."""
        self._drip = drip

    def start_drip(self, drip: Drip, start: Start) -> None:
        """Start a program that is still arriving."""
        self.program, self._drip = drip.program, drip
        self.runner.stream.host.skips_always = start.is_skipping
        options = Options(start.is_dry, stops_optionally=start.stops_optionally, is_repeated=False)
        self.runner.run(drip.entries, options)

    def _interpreter(self, program: Program, start: Start) -> Interpreter:
        reading = Reading(is_dry=start.is_dry, has_block_ends=True)
        self.runner.stream.host.skips_always = start.is_skipping
        cells = Shadow(self.cells) if start.line > 1 else self.cells
        if self.reader is not None:
            cells, reading.attend = self.reader.cells(cells), self.reader.attend
        run = Interpreter(program, cells, self.runner.stream.host, start.dialect, reading)
        if self.reader is not None:
            self.reader.begin(run)
        return run

    def _watched(self, entries: Iterator[c.Entry]) -> Iterator[c.Entry]:
        """Pass the entries on; on the virtual machine endless waits for inputs are skipped."""
        for entry in entries:
            if self.is_virtual and isinstance(entry, c.WaitBit) and entry.limit_s == math.inf:
                yield c.Say(entry.source, f"skipped: {entry.reason}")
            else:
                yield entry

    def run_blocks(
        self, blocks: Iterable[str | None], dialect: str, attend: Callable[["MillSession"], None]
    ) -> Iterator[c.Point]:
        """Run blocks one by one (MDI); yields the machine position after each.

        While the next block is None (still being typed) the machine is polled.
        """
        typed = self.mdi(dialect)
        for block in blocks:
            if block is None:
                self.step()
            else:
                self.start_block(typed, block)
                self._finish(attend)
                yield self.runner.stream.host.position()
            if self.runner.alarms.bars_start:
                return

    def mdi(self, dialect: str) -> Mdi:
        """Begin a session of MDI at the position of the machine; `typed` is its text."""
        folders = folders_of(self.cells, self._folder)
        program = load_blank(self.cells, dialect, folders, name="MDI")
        self.reading = Interpreter(program, self.cells, self.runner.stream.host, dialect)
        typed = Mdi(self.reading)
        self.typed = typed.text
        return typed

    def start_block(self, typed: Mdi, block: str) -> None:
        """Start one block of MDI; BlockError if it is invalid, UserError while the machine runs.

        It is executed up to its first entry before: what only execution finds (an arc without a
        centre) is refused as well, and nothing moves.
        """
        self.runner.require_start()
        entries = _ended(typed.execute(block))
        begun = list(islice(entries, 1))
        options = Options(is_mdi=True, is_repeated=False)
        self.runner.run(partial(_given, chain(begun, entries)), options)

    def jog(
        self, distances: Iterable[tuple[str, float]], attend: Callable[["MillSession"], None]
    ) -> None:
        """Jog axes, each by a distance."""
        numbers = {axis.name: axis.index for axis in self.runner.settings.axes}
        for name, distance_u in distances:
            self.runner.jog(partial(Jogging.move, axis=numbers[name], distance_u=distance_u))
        self._finish(attend)

    def home(self, names: str, attend: Callable[["MillSession"], None]) -> list[str]:
        """Home the named axes, or all that have a priority; returns the names of homed axes."""
        settings = self.runner.settings
        chosen = [settings.named(name) for name in names or settings.names()]
        self.runner.home([axis.index for axis in chosen])
        self._finish(attend)
        return [axis.name for axis in chosen if settings.is_homed(axis.index)]

    def _finish(self, attend: Callable[["MillSession"], None]) -> None:
        while self.runner.is_busy:
            self.step()
            attend(self)

    def step(self) -> None:
        """Wait one poll period and do what is due."""
        self._pass_time()
        self.poll()

    @property
    def poll_in_s(self) -> float:
        """The time until the next poll: a period, or to the end of a running wait if earlier."""
        return min(POLL_S, max(self.runner.wait_left_s, SHORTEST_S))

    def poll(self) -> None:
        """Do what is due now; the caller lets `poll_in_s` pass between two calls."""
        if not self.is_set_up:
            self.machine.poll()
            return
        if self._drip is not None:
            self._drip.poll()
        self._keep_ownership()
        self.runner.step()
        self._free_port()
        with suppress(*LINK_ERRORS):  # the next poll reports it
            self.messages.poll(self.machine.now_s)

    def _free_port(self) -> None:
        """Close the line of a program that has ended: others may read it."""
        if self._drip is not None and not self.runner.is_busy:
            self._drip.close()
            self._drip = None

    def _pass_time(self) -> None:
        """Wait until the next poll; on the virtual machine only until motion begins or ends."""
        step_s = self.poll_in_s
        card = self.virtual_card
        if card is None:
            self.machine.pause(step_s)
            return
        card.watch([self.motion])
        try:
            self.machine.pause(step_s)
        finally:
            card.watch()

    def _keep_ownership(self) -> None:
        """Renew ownership before anything is sent: this process may have been suspended."""
        is_ours = True
        if self._owner is not None and not self.runner.is_out_of_reach:
            with suppress(*LINK_ERRORS):  # the next poll reports it
                is_ours = self._owner.beat(self.card.now_s())
        if not is_ours:
            self.runner.disown()

    def _note_message(self, message: Message, is_on: bool) -> None:
        if is_on and message.is_alarm:
            detail = f"{message.number}: {message.shown}"
            self.runner.alarms.raise_alarm(alarms.USER_MESSAGE, detail, self.machine.now_s)
        self.show_message(message, is_on)

    def carry_on(self) -> None:
        """Act for an operator: continue after stops, confirm tools."""
        runner = self.runner
        runner.entry_actions.changer.confirm()
        if runner.state is State.HOLD:
            runner.start()


def _folder_of(store: Store) -> Path | None:
    return store.path.parent if store.path else None


def _say_message(say: Callable[[str], None], message: Message, is_on: bool) -> None:
    say(f"message {message.number}: {message.shown}" + ("" if is_on else " (over)"))


def _error_log(cells: Cells, folder: Path | None) -> Path | None:
    """The file alarms are appended to, where the store wants one."""
    if folder is None or cells.read(CONTROL.disable_error_file):
        return None
    return folder / (cells.read_text(GENERAL.error_log_name) or "MILL.LOG")


def _given(entries: Iterator[c.Entry], _host: RunHost) -> Iterator[c.Entry]:
    """Entries that exist already."""
    return entries


def _ended(entries: Iterator[c.Entry]) -> Iterator[c.Entry]:
    """The entries of a block, followed by an end that switches nothing off."""
    last = c.Source("MDI", 1, "")
    for entry in entries:
        last = getattr(entry, "source", last)
        yield entry
        if isinstance(entry, c.End):
            return
    yield c.End(last, is_by_code=False)
