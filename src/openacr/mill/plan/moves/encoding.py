"""Encoding of canonical moves: the data the planner needs of a move, and its packet.

A packet never depends on the one before it: velocity and ramp are sent with every move,
targets and centres are absolute pulses. They are whole numbers, because a single-precision
float cannot hold 0.00001 inch over 200 inches.
"""

import math
from collections.abc import Iterator, Sequence

from msgspec.structs import replace

from openacr.cnc.canonical import (
    Arc,
    Line,
    Moves,
    Pace,
    PathMode,
    Plane,
    Point,
    Polyline,
    Probe,
    Rapid,
    Source,
)
from openacr.compiled import pick
from openacr.mill.config.curves import can_plan
from openacr.mill.config.settings import S_PER_MIN, Settings
from openacr.mill.plan.moves.arcs import chords
from openacr.mill.plan.moves.move_law import MoveLaw, Shape
from openacr.mill.plan.moves.move_rows_cy import move_pulses
from openacr.mill.plan.moves.planning import PlannedMove
from openacr.protocol.move import Move
from openacr.protocol.move_codes import Code0, Code1, Code3

Motion = Rapid | Line | Arc | Probe
Pulses = Sequence[int]  # of a machine position, one value per configured axis
LONG_MAX = (1 << 31) - 1
_pulses = pick(move_pulses)

# How a move ends, in the two mode bits of header code 0 (Enable Rapid Move Modes is set).
CONTINUOUS = 0
CORNERING = int(Code0.MOVE_MODE_BIT_0)
STOPPING = int(Code0.MOVE_MODE_BIT_1)
RAPID = CORNERING | STOPPING
ALWAYS = int(Code0.COUNTER | Code0.ACC | Code0.VEL | Code0.CODE_3_PRESENT)
PLANES = {Plane.XY: 0, Plane.YZ: int(Code1.PLANE_BIT_0), Plane.ZX: int(Code1.PLANE_BIT_1)}
CARD_PLANE_AXES = (0, 1, 2)


class Job(PlannedMove, kw_only=True):
    """One move to be sent to the card: its plan and its end points."""

    entry: Motion
    begin: Point  # machine positions
    finish: Point
    begin_cnt: Pulses
    finish_cnt: Pulses
    jerk_ups3: float = 0.0  # along its path, as a move of its own
    path_tolerance_u: float = 0.0  # of a path planned with a jerk limit, 0: a move of its own
    is_in_curve: bool = False  # its path is part of a planned curve
    count: int = 0  # the number of its first packet, 0 until it is sent
    last: int = 0  # the number of its last packet
    block: int = 0  # blocks that end before it


class Encoder:
    """Converts canonical moves to jobs and packets, for the axes of one machine."""

    def __init__(self, settings: Settings, *, is_dry: bool = False, rounds: bool = False) -> None:
        """`rounds`: the card supports path tolerances, an extension that real cards lack."""
        self._settings = settings
        self._speeds = settings.speeds
        self._law = MoveLaw(settings, is_dry=is_dry)
        self._axes = [axis.index for axis in settings.axes]
        self._scale = [0.0] * 8
        for axis in settings.axes:
            self._scale[axis.index] = axis.pulses_per_unit
        # Whether the card can run the arcs of every plane.
        self.runs_arcs = all(map(self._runs, Plane))
        self._is_dry = is_dry
        self._rounds = rounds and settings.speeds.jerk_ups3 <= 0.0
        self._plans = can_plan(settings)
        self.jerk_ups3 = settings.lowest_jerk_ups3  # of the card, between moves that allow more

    # --- planning ---------------------------------------------------------------------

    def jobs(self, entry: Motion | Polyline | Moves, begin: Point) -> Iterator[Job]:
        """Split canonical moves into the moves that the card executes."""
        if isinstance(entry, Moves):
            for one in entry.entries():
                yield from self.jobs(one, begin)
                begin = one.end
            return
        if isinstance(entry, Polyline):
            yield from self._lines(entry, begin)
            return
        if isinstance(entry, Arc) and not self._runs(entry.plane):
            yield from self._chord_jobs(entry, begin)
        else:
            yield self.job(entry, begin)

    def _chord_jobs(self, arc: Arc, begin: Point) -> Iterator[Job]:
        """The chords of an arc, no faster than the arc itself where they are moves of their own."""
        whole = self.job(arc, begin)
        for chord in chords(arc, begin, self._speeds.chord_u):
            job = self.job(chord, begin)
            if not job.tolerance_u and not job.path_tolerance_u:
                job.feed_ups = min(job.feed_ups, whole.feed_ups)
                job.ramp_ups2 = min(job.ramp_ups2, whole.ramp_ups2)
            yield job
            begin = chord.end

    def _lines(self, entry: Polyline, begin: Point) -> Iterator[Job]:
        file, pace = entry.source.file, entry.pace
        begin_cnt: Pulses | None = None
        for end, line in zip(entry.ends.tolist(), entry.lines.tolist(), strict=True):
            one = Line(Source(file, line, ""), tuple(end), pace)  # text: read from the file
            job = self.job(one, begin, begin_cnt, is_in_polyline=True)
            begin, begin_cnt = one.end, job.finish_cnt
            yield job

    def job(
        self,
        entry: Motion,
        begin: Point,
        begin_cnt: Pulses | None = None,
        *,
        is_in_polyline: bool = False,
    ) -> Job:
        """Describe one move for the planner; `begin_cnt` are the pulses of its begin, if known."""
        planned_u = 0.0
        if isinstance(entry, (Line, Arc)):
            planned_u = self._planned_tolerance(entry.pace)
        shape = self._shape(entry, begin, planned_u, is_in_polyline=is_in_polyline)
        return Job(
            length_u=shape.length_u,
            feed_ups=shape.feed_ups,
            ramp_ups2=shape.ramp_ups2,
            tolerance_u=shape.tolerance_u,
            start=shape.start,
            end=shape.end,
            turns=shape.turns,
            mode=PathMode.EXACT if isinstance(entry, Rapid) else _mode(entry),
            is_rapid=isinstance(entry, Rapid),
            entry=entry,
            begin=begin,
            finish=entry.end,
            begin_cnt=self.pulses(begin) if begin_cnt is None else begin_cnt,
            finish_cnt=self.pulses(entry.end),
            jerk_ups3=shape.jerk_ups3,
            path_tolerance_u=planned_u,
        )

    def _shape(
        self, entry: Motion, begin: Point, planned_u: float, *, is_in_polyline: bool
    ) -> Shape:
        if isinstance(entry, Rapid):
            return self._law.straight(begin, entry.end)
        wanted_ups = self.line_speed(entry.pace)
        if isinstance(entry, Arc):
            return self._law.arc(entry, begin, wanted_ups, is_planned=planned_u > 0.0)
        tolerance_u = self.tolerance(entry.pace) if isinstance(entry, Line) else 0.0
        return self._law.straight(
            begin, entry.end, wanted_ups, tolerance_u, is_in_polyline=is_in_polyline
        )

    def sent_length_u(self, job: Job) -> float:
        """The length of a move between whole pulses, and of an arc about a centre on them."""
        begin, end, arc = self._place(job.begin_cnt), self._place(job.finish_cnt), job.entry
        if not isinstance(arc, Arc):
            travel = [b - a for a, b in zip(job.begin_cnt, job.finish_cnt, strict=True)]
            return self._law.straight(self._place([0] * len(travel)), self._place(travel)).length_u
        plane = arc.plane.first, arc.plane.second
        pairs = zip(plane, arc.centre, strict=True)
        x, y = (self._pulse(axis, at_u) / self._scale[axis] for axis, at_u in pairs)
        from_rad, to_rad = (
            math.atan2(point[plane[1]] - y, point[plane[0]] - x) for point in (begin, end)
        )
        turns = round((arc.sweep_rad - (to_rad - from_rad)) / math.tau)
        sweep_rad = to_rad - from_rad + math.tau * turns
        sent = replace(arc, end=end, centre=(x, y), sweep_rad=sweep_rad)
        return self._law.arc(sent, begin).length_u

    def _place(self, counts: Pulses) -> Point:
        """The machine position of whole pulses."""
        point = [0.0] * len(self._scale)
        for axis, count in zip(self._axes, counts, strict=True):
            point[axis] = count / self._scale[axis]
        return tuple(point)

    def tolerance(self, pace: Pace) -> float:
        """The largest deviation of the path at corners between straight moves."""
        if not self._rounds or pace.is_confirmed or pace.mode is not PathMode.FREE:
            return 0.0
        return pace.tolerance_u

    def _planned_tolerance(self, pace: Pace) -> float:
        """The tolerance with which the path of a move is planned, 0: it is a move of its own."""
        is_free = pace.mode in (PathMode.FREE, PathMode.CORNER)
        if not self._plans or pace.is_confirmed or pace.is_locked or not is_free:
            return 0.0
        return pace.tolerance_u or self._speeds.path_tolerance_u

    def line_speed(self, pace: Pace) -> float:
        """The programmed speed of a feed move."""
        return self._speeds.trial_ups if self._is_dry else pace.feed_upm / S_PER_MIN

    # --- packets ----------------------------------------------------------------------

    def packet(self, job: Job) -> Move | None:
        """Encode the packet of a move; None when it ends on the pulse where it begins."""
        entry = job.entry
        ends = zip(self._axes, job.begin_cnt, job.finish_cnt, strict=True)
        in_plane = (entry.plane.first, entry.plane.second) if isinstance(entry, Arc) else ()
        moved = {axis: end for axis, begin, end in ends if end != begin or axis in in_plane}
        if not moved:
            return None
        mode, fvel = _ending(job)
        locked = Code0.OVERRIDE_LOCKOUT if _is_locked(entry) else 0
        codes1, centers = self._arc(entry)
        return Move.of(
            moved,
            master=self._settings.master,
            code0=ALWAYS | mode | int(locked),
            code1=codes1,
            code3=int(Code3.FVEL) if fvel is not None else 0,
            vel=job.feed_ups,
            fvel=fvel,
            acc=job.ramp_ups2,
            centers=centers,
            tolerance=job.tolerance_u if job.is_joined else None,
        )

    def _arc(self, entry: Motion) -> tuple[int, tuple[int, int] | None]:
        if not isinstance(entry, Arc):
            return 0, None
        first, second = entry.plane.first, entry.plane.second
        turn = int(Code1.COUNTERCLOCKWISE) if entry.sweep_rad > 0 else 0
        centre = (self._pulse(first, entry.centre[0]), self._pulse(second, entry.centre[1]))
        return PLANES[entry.plane] | turn, centre

    def pulses(self, point: Point) -> Pulses:
        """Convert a machine position to pulses of the configured axes."""
        return [self._pulse(axis, point[axis]) for axis in self._axes]

    def _pulse(self, axis: int, position_u: float) -> int:
        return int(_pulses(position_u, self._scale[axis]))

    def beyond_pulses(self, job: Job) -> str | None:
        """The axis and position that exceed the 32 bits of a packet for pulses; None if all fit."""
        linear = "mm" if self._settings.is_metric else "inch"
        for axis, end in zip(self._settings.axes, job.finish_cnt, strict=True):
            if abs(end) > LONG_MAX:
                unit = linear if axis.is_linear else "degrees"
                return f"axis {axis.name} at {job.finish[axis.index]:g} {unit}"
        return None

    # --- forms the card supports ---------------------------------------------------------

    def _runs(self, plane: Plane) -> bool:
        """Whether the card can run arcs: X Y Z with equal pulses per unit in the plane."""
        first, second = plane.first, plane.second
        is_supported = first in CARD_PLANE_AXES and second in CARD_PLANE_AXES
        return is_supported and self._scale[first] == self._scale[second]


def _mode(entry: Line | Arc | Probe) -> PathMode:
    return PathMode.EXACT if entry.pace.is_confirmed else entry.pace.mode


def _is_locked(entry: Motion) -> bool:
    if isinstance(entry, Rapid):
        return False
    return entry.pace.is_locked or entry.pace.mode is PathMode.LOCKED


def _ending(job: Job) -> tuple[int, float | None]:
    """The mode bits for the planned end of a move, and its final velocity.

    A corner that the card rounds is planned by the card; the move ends at rest if the next one
    does not come in time.
    """
    if job.is_rapid:
        return RAPID, None
    if job.is_joined or job.exit_ups <= 0.0 or isinstance(job.entry, Probe):
        return STOPPING, None
    if job.exit_ups >= job.feed_ups:
        return CONTINUOUS, None
    return CORNERING, job.exit_ups
