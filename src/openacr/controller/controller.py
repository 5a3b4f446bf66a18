"""The composition root: one virtual card with the world around it.

Everything that changes a card from outside enters here - bytes on a stream, an input that
switches - and is noted in the journal with its tick. Same entries at same ticks, same
state: `digest` is equal on every machine build of the core.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import cast

import numpy as np

from openacr.basic.control import ProgramControl
from openacr.basic.executor import Executor
from openacr.basic.parser import join_names
from openacr.basic.plc_names import PlcNames
from openacr.basic.program_memory import PROGRAMS
from openacr.basic.system import System
from openacr.compiled import pick
from openacr.controller import snapshot as snapshots
from openacr.controller.journal import Entered, JournalEntry, Recorder
from openacr.controller.loading import PATIENCE_S, Loader, LoadError
from openacr.controller.packets import PacketHost
from openacr.controller.persistence import Persistence
from openacr.controller.ring import Ring
from openacr.controller.streams import CONSOLE, Streams
from openacr.controller.trace import Reals, Trace, build_trace
from openacr.controller.views import AxisView, Bits, Parameters
from openacr.engine import loop_cy
from openacr.engine.watches import Watch, give_orders, set_watches, take_orders
from openacr.errors import CardError, SourceError, StoreError, UserError
from openacr.lang.lexer import Token
from openacr.map.numbers import (
    AX_ACTUAL_POSITION,
    AXF_PEAK_ERROR_CNT,
    AXF_PEAK_VELOCITY_CPS,
    AXF_TRAVEL_CNT,
    AXI_POSITION_INDEX,
    ENGI_BASE,
    ENGI_STOP,
    ENGI_TICKS_LEFT,
    ENGI_TRACE_EVERY,
    ENGI_TRACE_PEAKS,
    ENGI_TRACE_ROW,
    ENGI_TRACE_ROWS,
    ENGI_TRACE_WAIT,
    ENGI_UNTIL_MASK,
    ENGI_UNTIL_STATE,
    ENGI_UNTIL_WORD,
    ENGI_WATCH_COUNT,
    ENI_BASE,
    ENI_MULT,
    ENI_STRIDE,
    P_CARD_SERIAL_NUMBER,
    PLC_COUNT,
)
from openacr.models import MODELS, Model
from openacr.motion import drive
from openacr.motion.card import Card
from openacr.motion.permits import scale_of
from openacr.motion.rows import axis_ints, axis_parameter, axis_reals
from openacr.network.networks import Networks
from openacr.plant import apply, load, schema, terminals
from openacr.plc.control import Plcs
from openacr.plc.reader import PlcLine, read_line
from openacr.project import Project, find_project
from openacr.protocol.stream import StreamKind
from openacr.protocol.terminal import ControlKey
from openacr.views import F64

RAW_COUNTS = 4  # of an encoder per line, at MULT 4
TRACE_CHUNK_ROWS = 65536

_engine_run = pick(loop_cy.engine_run)
_NO_TRACE = memoryview(bytearray(8)).cast("d")


@dataclass(frozen=True, slots=True)
class AxisStatistics:
    """What an axis has done since power-up, in its units."""

    position_u: float
    actual_u: float
    distance_u: float
    peak_velocity_ups: float
    peak_following_error_u: float


class Controller:
    """A virtual card; see design notes in docs/overview.md."""

    def __init__(
        self,
        model: str | Model = "ACR9000",
        *,
        world: schema.World | None = None,
        data: Path | None = None,
    ) -> None:
        self.model = _model(model)
        self.world = world or schema.default_world(self.model)
        self.card = Card(self.model)
        self.memory = self.card.memory
        self.system = System(self.card)
        self.executor = Executor(self.system)
        self.plcs = Plcs(self.memory, self._plc_text)
        self.networks = Networks(self.memory, self._deliver)
        self.control = ProgramControl(self.system, self.executor, self.plcs)
        self.system.control = self.control
        self.system.runner = self.executor
        self.system.reboot = self._ask_reboot
        self.system.read_plc = self._read_plc
        self.streams = Streams(self.system.sessions, PacketHost(self.card), self._press)
        self.p = Parameters(self.memory, partial(self._note, Entered.PARAMETER))
        self.bit = Bits(self.memory, partial(self._note, Entered.FLAG))
        self.journal: list[JournalEntry] = []
        self.is_journalled = True
        self.recorder: Recorder | Ring | None = None
        self._console: int | None = None
        self._trace_parts: list[Reals] = []
        self._trace_buffer: Reals | None = None
        self._trace_view = _NO_TRACE
        self._wants_reboot = False
        self._look: Callable[[], bool] | None = None
        self._lived_before_tk = 0
        self._apply_world()
        self.nonvolatile = Persistence.open(self.system, data)
        self.nonvolatile.power_up()
        self._start_boot_programs()

    @classmethod
    def from_project(cls, path: str | Path) -> Controller:
        """A card with a project folder or controller file loaded; LoadError if it refuses lines."""
        controller, errors = cls.load(find_project(path))
        if errors:
            raise LoadError(errors)
        return controller

    @classmethod
    def load(
        cls, project: Project, *, data: Path | None = None
    ) -> tuple[Controller, list[SourceError]]:
        """A card with a project loaded, and the lines it has refused.

        A card that finds programs in its data folder keeps them; of the project it takes
        the world alone, as a machine whose card is switched on again.
        """
        world = load.load_world(project.machine) if project.machine else None
        controller = cls(str(world.card.model) if world else "ACR9000", world=world, data=data)
        if not all(map(controller.system.programs.is_empty, controller.system.owners())):
            controller.nonvolatile.shelf.notice(
                f"the card has programs in {data} and keeps them; of {project.root} only the"
                " machine is used (give an empty folder to load its programs)"
            )
            return controller, []
        session = controller.system.sessions[CONSOLE]
        session.connect()
        errors = Loader(session, controller._wait_for_console_line).load(project)
        session.disconnect()
        try:
            controller.system.start_boot_programs()
        except CardError as error:
            errors.append(SourceError(error.text, path=str(project.root)))
        return controller, errors

    # time

    @property
    def tick(self) -> int:
        """Servo interrupts since power-up."""
        return self.card.tick

    @property
    def lived_tk(self) -> int:
        """Ticks this card has lived altogether; restarting it does not begin anew."""
        return self._lived_before_tk + self.tick

    @property
    def time_s(self) -> float:
        """Simulated seconds since power-up."""
        return self.tick * self.period_s

    @property
    def period_s(self) -> float:
        """Length of a tick [s]."""
        return self.card.period_s

    def advance(self, ticks: int = 0, *, seconds: float = 0.0) -> None:
        """Let the card live for so many ticks (or seconds), or until a watch ends it."""
        self._live(ticks + round(seconds / self.period_s))

    def until(
        self, bit: int, is_: bool = True, *, timeout_s: float = 60.0, ticks: int | None = None
    ) -> bool:
        """Let the card live until a flag has this state; False if it has not in time."""
        if self.memory.bit(bit) == is_:
            return True
        self._set_engine(ENGI_UNTIL_WORD, 4096 + (bit >> 5))
        self._set_engine(ENGI_UNTIL_MASK, 1 << bit % 32 if bit % 32 < 31 else -(1 << 31))
        self._set_engine(ENGI_UNTIL_STATE, int(is_))
        limit = round(timeout_s / self.period_s) if ticks is None else ticks
        reason = self._live(limit)
        self._set_engine(ENGI_UNTIL_WORD, 0)
        return reason == loop_cy.UNTIL_MET

    def _live(self, ticks: int) -> int:
        """Run the engine, with a stop wherever the journal wants a digest; why it ended."""
        while True:
            step = ticks
            if self.recorder is not None:
                step = min(ticks, self.recorder.next_tk - self.lived_tk)
            before = self.lived_tk
            self._set_engine(ENGI_TICKS_LEFT, step)
            reason = self._run()
            ticks -= self.lived_tk - before
            if self.recorder is not None and self.lived_tk >= self.recorder.next_tk:
                self.recorder.mark()
            if reason != loop_cy.DONE or ticks <= 0 or self.recorder is None:
                self.nonvolatile.battery.follow_in_time()
                return reason

    def watch(self, watches: Sequence[Watch] = (), look: Callable[[], bool] | None = None) -> None:
        """End `advance` and `until` early from now on, behind the tick in which it happened.

        It ends when a watch has changed, or when `look`, which is asked behind every tick in
        which statements were performed that can print or answer, returns True.
        """
        set_watches(self.memory, watches)
        self._look = look

    def _run(self) -> int:
        """Run the engine to the end of its ticks or until what was awaited; why it ended."""
        memory, space = self.memory, self.executor.space
        while True:
            reason = _engine_run(
                memory.F, memory.I, memory.S, space.code, space.nums, self._trace_view
            )
            if reason in (loop_cy.DONE, loop_cy.UNTIL_MET, loop_cy.WATCH):
                return reason
            if reason == loop_cy.STOPPED:
                if self._look is not None and self._look():
                    return reason
            elif reason == loop_cy.TRACE_FULL:
                self._next_trace_part()
            else:
                self._attend(reason)
                if self._wants_reboot:
                    self._reboot()
                    if self._look is not None or memory.I[ENGI_BASE + ENGI_WATCH_COUNT]:
                        return loop_cy.WATCH

    def _attend(self, reason: int) -> None:
        """Do what the engine leaves to Python."""
        if reason == loop_cy.REQUESTS:
            self.control.scan()
        elif reason == loop_cy.ROOM:
            self.streams.moves.drain()
        elif reason == loop_cy.NETWORKS:
            self.networks.attend()
            self.streams.settle()
        else:
            self.executor.attend(reason - loop_cy.THREAD)
            self.streams.settle()
        if self._look is not None:
            self._set_engine(ENGI_STOP, 1)

    def _set_engine(self, row: int, value: int) -> None:
        self.memory.I[ENGI_BASE + row] = value

    # streams

    def open_stream(self, kind: StreamKind, name: str | None = None) -> int:
        """A stream for a new connection; NoFreeStreamError when all (or that one) are taken."""
        stream = self.streams.open(kind, name)
        self._note(Entered.OPEN, stream, text=kind.value, name=name or "")
        return stream

    def close_stream(self, stream: int) -> None:
        """The connection ended; motion and programs go on."""
        self._note(Entered.CLOSE, stream)
        self.streams.close(stream)

    def receive(self, stream: int, data: bytes) -> None:
        """Bytes that arrived together, at the present tick."""
        self._note(Entered.BYTES, stream, text=data.decode("latin-1"))
        self.streams.receive(stream, data, self.tick)
        if self._wants_reboot:
            self._reboot()
        self.nonvolatile.battery.follow()

    def _deliver(self, channel: int, text: str) -> None:
        """Write something on a channel by its number."""
        for session in self.system.sessions.values():
            if session.index == channel:
                session.write(text)

    def accepts_input(self, stream: int) -> bool:
        """False while the sender should be held back."""
        return self.streams.accepts_input(stream)

    def replying(self, stream: int) -> bool:
        """True while a line is on its way to an answer and not blocked."""
        session = self.streams.session(stream)
        if session is None or not session.busy:
            return False
        return not self.executor.is_waiting(session.thread)

    def take_output(self, stream: int) -> bytes:
        """The bytes of the next write, none when there is nothing to send."""
        return self.streams.take_output(stream)

    @property
    def console(self) -> int:
        """The stream of this process, opened at first use."""
        if self._console is None:
            self._console = self.open_stream(StreamKind.TERMINAL, CONSOLE)
        return self._console

    def send(self, text: str) -> str:
        """Type text on the console; what the card has answered so far."""
        self.receive(self.console, text.encode("latin-1"))
        return self.take_output(self.console).decode("latin-1")

    def press(self, key: ControlKey) -> None:
        """Ctrl-X kills motion and ends programs, Ctrl-Y lifts kills, Ctrl-Z also drops drives."""
        self._note(Entered.KEY, int(key))
        self._press(key)

    def _press(self, key: ControlKey) -> None:
        if key is ControlKey.CTRL_Y:
            drive.clear_kills(self.card)
            return
        for program in range(PROGRAMS):
            self.executor.halt_program(program)
        for plc in range(PLC_COUNT):
            self.plcs.halt(plc)
        drive.kill_all(self.card)
        if key is ControlKey.CTRL_Z:
            drive.disable_all(self.card)

    def listen(self, hear: Callable[[int, str], None]) -> None:
        """Call `hear(program, text)` with everything programs print."""
        self.system.listeners.taps.append(hear)

    # the world

    def set_input(self, bit: int, on: bool) -> None:
        """Switch an input that no part of the world drives, onboard or at a CANopen node."""
        if terminals.input_terminal(bit) is None:
            self.memory.set_bit(bit, on)
        elif not terminals.switch(self.memory, bit, on):
            raise UserError(f"input {bit}: no CANopen node of the machine has it")
        self._note(Entered.INPUT, bit, on)

    def _note(
        self, what: Entered, number: int, value: float = 0.0, *, text: str = "", name: str = ""
    ) -> None:
        """Enter something that comes from outside into the journals."""
        if self.is_journalled or self.recorder is not None:
            entry = JournalEntry(self.lived_tk, what, number, text, float(value), name)
            if self.is_journalled:
                self.journal.append(entry)
            if self.recorder is not None:
                self.recorder.note(entry)

    def set_analog(self, parameter: int, value: float) -> None:
        """Bring a value, in its unit, to the analog input of a node that a parameter shows."""
        place = terminals.analog_input(self.memory, parameter)
        if place is None:
            raise UserError(f"P{parameter} shows no analog input of a node")
        self.memory.F[place] = value
        self._note(Entered.ANALOG, parameter, value)

    def drag(self, axis: int, by_u: float) -> None:
        """Push the load of an axis by hand, at once; it takes part in the physics after that."""
        encoder = self.memory.I[axis_ints(axis) + AXI_POSITION_INDEX]
        mult = self.memory.I[ENI_BASE + encoder * ENI_STRIDE + ENI_MULT] or 1
        pulses = by_u * scale_of(self.card, axis)
        if not apply.push(self.memory, encoder, pulses * RAW_COUNTS / mult):
            row = axis_parameter(axis) + AX_ACTUAL_POSITION
            self.memory.write(row, self.memory.I[row] + round(pulses))
        self._note(Entered.DRAG, axis, by_u)

    def _apply_world(self) -> None:
        apply.apply_world(self.world, self.memory)
        self.card.set_period(self.world.card.period_s)
        self.memory.I[P_CARD_SERIAL_NUMBER] = self.model.serial_number
        self.networks.power_up()

    # reading

    def axis(self, number: int) -> AxisView:
        """One axis, for reading."""
        if not 0 <= number < self.model.axes:
            raise UserError(
                f"axis {number}: the {self.model.name} has axes 0-{self.model.axes - 1}"
            )
        return AxisView(self.card, number)

    def statistics(self, axis: int) -> AxisStatistics:
        """What an axis has done since power-up."""
        scale = abs(scale_of(self.card, axis))
        reals = axis_reals(axis)
        view = AxisView(self.card, axis)
        memory = self.memory.F
        return AxisStatistics(
            view.commanded_u,
            view.actual_u,
            memory[reals + AXF_TRAVEL_CNT] / scale,
            memory[reals + AXF_PEAK_VELOCITY_CPS] / scale,
            memory[reals + AXF_PEAK_ERROR_CNT] / scale,
        )

    def digest(self) -> str:
        """Fingerprint of the state; what this process asked of the engine does not count."""
        orders = take_orders(self.memory)
        digest = self.memory.digest()
        give_orders(self.memory, orders)
        return digest

    # recording

    def record(self, every_tk: int = 1, *, keep_peaks: bool = False) -> None:
        """Record all axes every so many ticks from now on.

        With `keep_peaks` no peak of velocity or following error between two samples is lost:
        every other sample has the lowest value since the one before, the next the highest.
        """
        self._trace_parts = []
        self._set_engine(ENGI_TRACE_PEAKS, int(keep_peaks))
        self._set_engine(ENGI_TRACE_EVERY, every_tk)
        self._set_engine(ENGI_TRACE_WAIT, 1)
        self._new_trace_buffer()

    def trace(self) -> Trace:
        """What has been recorded so far."""
        columns = self._trace_columns
        parts = [part.reshape(-1, columns) for part in self._trace_parts]
        if self._trace_buffer is not None:
            used = self.memory.I[ENGI_BASE + ENGI_TRACE_ROW]
            parts.append(self._trace_buffer.reshape(-1, columns)[:used])
        samples = np.concatenate(parts) if parts else np.empty((0, columns))
        scales = [scale_of(self.card, axis) for axis in range(self.model.axes)]
        return build_trace(samples, scales)

    @property
    def _trace_columns(self) -> int:
        return loop_cy.TRACE_HEAD + loop_cy.TRACE_AXIS * self.model.axes

    def _new_trace_buffer(self) -> None:
        self._trace_buffer = np.zeros(TRACE_CHUNK_ROWS * self._trace_columns)
        self._trace_view = cast(F64, self._trace_buffer.data)
        self._set_engine(ENGI_TRACE_ROW, 0)
        self._set_engine(ENGI_TRACE_ROWS, TRACE_CHUNK_ROWS)

    def _next_trace_part(self) -> None:
        if self._trace_buffer is not None:
            self._trace_parts.append(self._trace_buffer)
        self._new_trace_buffer()

    # snapshots

    def snapshot(self) -> snapshots.Snapshot:
        """The whole state at this tick."""
        return snapshots.take(self)

    def restore(self, snapshot: snapshots.Snapshot) -> None:
        """Return to a snapshot of this card, or of one with the same model and world.

        A journal on disk cannot tell of this: StoreError while one is written.
        """
        if self.recorder is not None:
            raise StoreError("a card that writes a journal cannot return to a snapshot")
        orders = take_orders(self.memory)
        snapshots.put_back(self, snapshot)
        give_orders(self.memory, orders)
        self._lived_before_tk = snapshot.lived_before_tk

    def take_over(self, snapshot: snapshots.Snapshot) -> None:
        """Become the card of a snapshot, with everybody who was connected to it."""
        self.restore(snapshot)
        snapshots.put_back_streams(self, snapshot)
        self._console = self.streams.number_of(CONSOLE)

    # the end

    def close(self) -> None:
        """Close the journal and the data folder; the card is not used any more."""
        if self.recorder is not None:
            self.recorder.close()
            self.recorder = None
        self.nonvolatile.close()

    # loading and restarting

    def _wait_for_console_line(self) -> bool:
        """Let time pass until the line on the loading session is done; False if it hangs."""
        session = self.system.sessions[CONSOLE]
        for _ in range(round(PATIENCE_S * 1000)):
            if not session.busy:
                return True
            self.advance(seconds=0.001)
        return False

    def _ask_reboot(self) -> None:
        self._wants_reboot = True

    def _reboot(self) -> None:
        """Restart as at power-up; the world outside stays as it is."""
        self._wants_reboot = False
        self._lived_before_tk += self.tick
        orders = take_orders(self.memory)
        outside = apply.take_state(self.memory)
        self.executor.reset()
        self.system.restart(keeps_memory=self.nonvolatile.battery.is_on)
        self.executor.space.rebuild()  # the rows that say whose code lies where are gone
        self._apply_world()
        apply.put_state(self.memory, outside)
        give_orders(self.memory, orders)
        self.nonvolatile.restart()
        self.streams.moves.clear()
        self.streams.disconnect_all()
        self._start_boot_programs()

    def _start_boot_programs(self) -> None:
        with suppress(CardError):  # nobody is connected who could be told
            self.system.start_boot_programs()

    # PLCs

    def _plc_text(self, plc: int) -> Iterator[tuple[int, PlcLine]]:
        for line in self.system.programs.lines(PROGRAMS + plc):
            yield line.number, line.tree

    def _read_plc(self, found: list[Token]) -> tuple[PlcLine | None, int]:
        join_names(found, self.system.aliases.numbered)
        line = read_line(found, PlcNames(self.system.aliases.nodes))
        return line, line.count if line else 0


def _model(model: str | Model) -> Model:
    if isinstance(model, Model):
        return model
    if model not in MODELS:
        raise UserError(f"controller model {model}: known are {', '.join(MODELS)}")
    return MODELS[model]
