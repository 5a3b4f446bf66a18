"""Reads the snapshots of a machine."""

from collections.abc import Callable
from math import nan

from openacr.cnc.canonical import Point
from openacr.cnc.interpreter.interpreter import Interpreter
from openacr.mill.card.actions import OFF
from openacr.mill.config.overrides import Override
from openacr.mill.run.lifecycle import State
from openacr.mill.session import MillSession
from openacr.mill.zeroing import reader
from openacr.panel.control.machine.place import Place, Rows, read_place
from openacr.panel.control.machine.snapshot import Axes, Light, Snapshot
from openacr.sysvar.tabs import CELLS

NEAR = 0.001  # share of the travel that counts as at the limit
PERCENT = 100.0
# What the shift between program and machine is made of.
FROM = range(CELLS.floating_zero_active, CELLS.work_system_in_use + 1)
LENGTHS = (CELLS.current_h_length, CELLS.current_h_wear)


class WorkSystem:
    """Program coordinates of machine positions: those of the program, else of MDI."""

    def __init__(self, session: MillSession) -> None:
        self._session = session
        self._idle = reader(session)
        self._parts: tuple[float, ...] = ()

    @property
    def run(self) -> Interpreter:
        """The interpreter whose modal state and offsets count."""
        session = self._session
        is_typed = session.runner.options.is_mdi
        if session.reading is not None and (session.runner.is_busy or is_typed):
            return session.reading
        return self._idle

    def program(self, machine: Point) -> Point:
        """A machine position in program coordinates."""
        run = self.run
        if not self._session.runner.is_busy:
            self._follow(run)
        coordinates = run.path.coordinates
        return coordinates.backward(coordinates.from_machine(machine))

    def _follow(self, run: Interpreter) -> None:
        """Take over offsets that were stored; a program under way keeps those it has read."""
        read = run.cells.read
        parts = (*map(read, FROM), *map(read, LENGTHS), float(run.modal.work), float(id(run)))
        if parts != self._parts:
            self._parts = parts
            run.path.coordinates.refresh(run.modal)


class Reading:
    """Reads one machine by `read`; `work` is the coordinate system positions are shown in."""

    def __init__(self, session: MillSession, read: Rows) -> None:
        self._session, self._read = session, read
        self.work = WorkSystem(session)

    def snapshot(
        self, number: int, tick_ms: float, now_s: float, left_s: float, line: int
    ) -> Snapshot:
        """Read the machine; a link error where its card does not answer.

        `left_s` is the predicted time to the end of the program, `line` the one it executes.
        """
        session, runner = self._session, self._session.runner
        if not session.is_set_up:  # positions in units that are not those of the card
            none = (nan,) * len(runner.settings.axes)
            return Snapshot(
                number=number, tick_ms=tick_ms, read_s=now_s, lights=Light.BARRED, work=none,
                commanded=none, actual=none, following=none, to_go=none, following_end=none,
            )  # fmt: skip
        place = read_place(runner.settings, self._read)
        to_go, following_end = self._ahead(place)
        cells = session.cells
        return Snapshot(
            number=number,
            tick_ms=tick_ms,
            read_s=now_s,
            state=runner.state,
            lights=self._lights(place),
            homed=self._mask(lambda axis: runner.settings.is_homed(axis)),
            jogging=place.moving,
            near_limit=self._near(place),
            line=line,
            tool=int(cells.read(CELLS.tool_in_spindle)),
            feed_upm=self.work.run.modal.feed,
            speed_upm=place.speed_upm,
            spindle_rpm=runner.entry_actions.spindle.rpm if self._spins else 0.0,
            feed_percent=PERCENT * runner.overrides.factor(Override.FEED),
            rapid_percent=PERCENT * runner.overrides.factor(Override.RAPID),
            spindle_percent=PERCENT * runner.overrides.factor(Override.SPINDLE),
            run_s=runner.run_s,
            left_s=left_s,
            parts=cells.read(CELLS.parts_finished),
            work=self._of_axes(self.work.program(self._point(place.commanded))),
            commanded=place.commanded,
            actual=place.actual,
            following=place.following,
            to_go=to_go,
            following_end=following_end,
        )

    @property
    def _spins(self) -> bool:
        return self._session.runner.entry_actions.spindle.state != OFF

    def _lights(self, place: Place) -> int:
        runner = self._session.runner
        options, host = runner.options, runner.stream.host
        coolant = runner.entry_actions.coolant
        lit = {
            Light.BUSY: runner.is_busy,
            Light.MOVING: place.is_moving,
            Light.DRY: options.is_dry and runner.is_busy,
            Light.SINGLE: options.is_single,
            Light.BARRED: runner.alarms.bars_start,
            Light.SKIP: host.is_block_skip_on(),
            Light.OPTIONAL: options.stops_optionally,
            Light.SPINDLE: self._spins,
            Light.FLOOD: coolant.has_flood,
            Light.MIST: coolant.has_mist,
            Light.TOOL: runner.entry_actions.changer.wants_confirmation,
            Light.QUESTION: runner.asking is not None,
            Light.HELD: runner.state is State.PAUSED and not place.is_moving,
            Light.EMERGENCY: any(a.kind.code == 10 for a in runner.alarms.active),
        }
        return sum(light for light, is_on in lit.items() if is_on)

    def _mask(self, holds: Callable[[int], bool]) -> int:
        axes = self._session.runner.settings.axes
        return sum(1 << k for k, axis in enumerate(axes) if holds(axis.index))

    def _near(self, place: Place) -> int:
        settings = self._session.runner.settings
        mask = 0
        for k, axis in enumerate(settings.axes):
            if axis.soft_limits is None or not settings.is_homed(axis.index):
                continue
            high, low = axis.soft_limits
            room = min(high - place.commanded[k], place.commanded[k] - low)
            mask |= (room <= NEAR * (high - low)) << k
        return mask

    def _ahead(self, place: Place) -> tuple[Axes, Axes]:
        """The distance to go of the executing move, and the end of the one after it."""
        tracker = self._session.runner.stream.tracker
        none = (nan,) * len(place.commanded)
        current = tracker.current
        if current is None or not self._session.runner.is_busy:
            return (0.0,) * len(place.commanded), none
        finish = self._of_axes(current.finish)
        to_go = tuple(end - at for end, at in zip(finish, place.commanded, strict=True))
        jobs = tracker.jobs()
        if len(jobs) < 2:
            return to_go, none
        return to_go, self._of_axes(self.work.program(jobs[1].finish))

    def _of_axes(self, point: Point) -> Axes:
        return tuple(point[axis.index] for axis in self._session.runner.settings.axes)

    def _point(self, values: Axes) -> Point:
        point = [0.0] * 8
        for axis, value in zip(self._session.runner.settings.axes, values, strict=True):
            point[axis.index] = value
        return tuple(point)
