"""Canonical moves as packets: what the planner needs to know of a move, and its bytes.

A packet never depends on the one before it: velocity and ramp are sent with every move,
targets and centres are absolute pulses. They are whole numbers, because a single-precision
float cannot hold 0.00001 inch over 200 inches.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

from openacr.cnc.canonical import Arc, Line, PathMode, Plane, Point, Polyline, Probe, Rapid
from openacr.mill.geometry import Geometry, Way
from openacr.mill.planning import Stretch
from openacr.mill.settings import S_PER_MIN, Settings
from openacr.protocol.move import Code0, Code1, Code3, Move

Motion = Rapid | Line | Arc | Probe
LONG_MIN, LONG_MAX = -(1 << 31), (1 << 31) - 1

# How a move ends, in the two mode bits of header code 0 (Enable Rapid Move Modes is set).
CONTINUOUS = 0
CORNERING = int(Code0.MOVE_MODE_BIT_0)
STOPPING = int(Code0.MOVE_MODE_BIT_1)
RAPID = CORNERING | STOPPING
ALWAYS = int(Code0.COUNTER | Code0.ACC | Code0.VEL | Code0.CODE_3_PRESENT)
PLANES = {Plane.XY: 0, Plane.YZ: int(Code1.PLANE_BIT_0), Plane.ZX: int(Code1.PLANE_BIT_1)}
CARD_PLANE_AXES = (0, 1, 2)


class BeyondPulsesError(ValueError):
    """E403: a position does not fit 32 bits of pulses."""


@dataclass(slots=True, kw_only=True)
class Job(Stretch):
    """One move on its way to the card: how it is planned, and where it goes."""

    entry: Motion
    begin: Point  # machine positions
    finish: Point
    count: int = 0  # the number of its packet, 0 while it has none
    block: int = 0  # blocks that end before it


class Encoder:
    """Jobs and packets for the axes of one machine."""

    def __init__(self, settings: Settings, *, is_dry: bool = False) -> None:
        self._settings = settings
        self._speeds = settings.speeds
        self._geometry = Geometry(settings)
        self._scale = [0.0] * 8
        for axis in settings.axes:
            self._scale[axis.index] = axis.pulses_per_unit
        self._is_dry = is_dry

    # --- planning ---------------------------------------------------------------------

    def job(self, entry: Motion, begin: Point) -> Job:
        """One move as the planner sees it."""
        way = self._way(entry, begin)
        is_rapid = isinstance(entry, Rapid)
        ramp = self._speeds.rapid_acc_ups2 if is_rapid else self._speeds.feed_acc_ups2
        return Job(
            length_u=way.length_u,
            feed_ups=self._speed(entry, way),
            ramp_ups2=self._geometry.ramp_limit(way, ramp),
            start=way.start,
            end=way.end,
            mode=PathMode.EXACT if isinstance(entry, Rapid) else _mode(entry),
            is_rapid=is_rapid,
            entry=entry,
            begin=begin,
            finish=entry.end,
        )

    def _way(self, entry: Motion, begin: Point) -> Way:
        if not isinstance(entry, Arc):
            return self._geometry.line(begin, entry.end)
        plane = (entry.plane.first, entry.plane.second)
        return self._geometry.arc(begin, entry.end, plane, entry.centre, entry.sweep_rad)

    def _speed(self, entry: Motion, way: Way) -> float:
        """Units per second (degrees where only rotary axes move), within all limits."""
        speeds = self._speeds
        if isinstance(entry, Rapid):
            wanted = min(speeds.rapid_ups, speeds.trial_ups) if self._is_dry else speeds.rapid_ups
        elif self._is_dry:
            wanted = speeds.trial_ups
        else:
            wanted = entry.pace.feed_upm / S_PER_MIN
        if isinstance(entry, Arc):
            # An arc needs v^2 / r across: it may not be more than the machine gives.
            radius = min(entry.start_radius, entry.end_radius)
            wanted = min(wanted, math.sqrt(speeds.arc_acc_ups2 * radius))
        return min(wanted, self._geometry.speed_limit(way))

    # --- packets ----------------------------------------------------------------------

    def packet(self, job: Job) -> Move | None:
        """The bytes of a move; None when it ends on the pulse where it begins."""
        entry = job.entry
        begin, finish = self.pulses(job.begin), self.pulses(job.finish)
        moved = {axis: end for axis, end in finish.items() if end != begin[axis]}
        if isinstance(entry, Arc):
            moved |= {axis: finish[axis] for axis in (entry.plane.first, entry.plane.second)}
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
        )

    def _arc(self, entry: Motion) -> tuple[int, tuple[int, int] | None]:
        if not isinstance(entry, Arc):
            return 0, None
        first, second = entry.plane.first, entry.plane.second
        turn = int(Code1.COUNTERCLOCKWISE) if entry.sweep_rad > 0 else 0
        centre = (self._pulse(first, entry.centre[0]), self._pulse(second, entry.centre[1]))
        return PLANES[entry.plane] | turn, centre

    def pulses(self, point: Point) -> dict[int, int]:
        """A machine position in pulses of the axes that are there."""
        axes = (axis.index for axis in self._settings.axes)
        return {axis: self._pulse(axis, point[axis]) for axis in axes}

    def _pulse(self, axis: int, position_u: float) -> int:
        exact = position_u * self._scale[axis]
        nearest = math.floor(abs(exact) + 0.5)  # half away from zero
        if nearest > LONG_MAX:
            raise BeyondPulsesError(f"E403 axis {axis}: {position_u:g} is beyond 32 bits of pulses")
        return nearest if exact >= 0 else -nearest

    # --- forms the card knows ---------------------------------------------------------

    def pieces(self, entry: Motion | Polyline, begin: Point) -> Iterator[Motion]:
        """A canonical move in forms the card can run: arcs it does not know become chords."""
        if isinstance(entry, Polyline):
            for end, line in zip(entry.ends.tolist(), entry.lines.tolist(), strict=True):
                yield Line(replace(entry.source, line=line, text=""), tuple(end), entry.pace)
        elif isinstance(entry, Arc) and not self._runs(entry):
            yield from self._chords(entry, begin)
        else:
            yield entry

    def _runs(self, arc: Arc) -> bool:
        """Whether the card can run an arc: X Y Z with equal pulses per unit in the plane."""
        first, second = arc.plane.first, arc.plane.second
        known = first in CARD_PLANE_AXES and second in CARD_PLANE_AXES
        return known and self._scale[first] == self._scale[second]

    def _chords(self, arc: Arc, begin: Point) -> Iterator[Line]:
        """Straight pieces whose height over the arc stays within the chord tolerance."""
        radius = max(arc.start_radius, arc.end_radius)
        height = min(self._speeds.chord_u, radius)
        half = math.acos(max(1.0 - height / radius, -1.0))
        count = max(1, math.ceil(abs(arc.sweep_rad) / (2.0 * half)))
        for number in range(1, count + 1):
            end = arc.end if number == count else along(arc, begin, number / count)
            yield Line(arc.source, end, arc.pace, arc.is_inserted, arc.is_compensated)


def along(arc: Arc, begin: Point, share: float) -> Point:
    """The point of an arc behind a share 0..1 of its sweep."""
    first, second = arc.plane.first, arc.plane.second
    start = math.atan2(begin[second] - arc.centre[1], begin[first] - arc.centre[0])
    angle = start + share * arc.sweep_rad
    radius = arc.start_radius + share * (arc.end_radius - arc.start_radius)
    point = [a + share * (b - a) for a, b in zip(begin, arc.end, strict=True)]
    point[first] = arc.centre[0] + radius * math.cos(angle)
    point[second] = arc.centre[1] + radius * math.sin(angle)
    return tuple(point)


def _mode(entry: Line | Arc | Probe) -> PathMode:
    return PathMode.EXACT if entry.pace.is_confirmed else entry.pace.mode


def _is_locked(entry: Motion) -> bool:
    if isinstance(entry, Rapid):
        return False
    return entry.pace.is_locked or entry.pace.mode is PathMode.LOCKED


def _ending(job: Job) -> tuple[int, float | None]:
    """The mode bits for the planned end of a move, and its final velocity."""
    if job.is_rapid:
        return RAPID, None
    if job.exit_ups <= 0.0 or isinstance(job.entry, Probe):
        return STOPPING, None
    if job.exit_ups >= job.feed_ups:
        return CONTINUOUS, None
    return CORNERING, job.exit_ups
