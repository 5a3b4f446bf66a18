"""A machine with a rotary axis and a jerk limit: programs, and how it moves, tick by tick."""

import math
from collections.abc import Sequence

import numpy as np
from tests.mill.planned import (
    ACCEL,
    FEED,
    JERK,
    SPEED,
    TOLERANCE,
    Action,
    Reals,
    planned_shop,
    recorded,
)
from tests.mill.shop import PULSES, Shop, end, src
from tests.trajectory.measures import off

from openacr.cnc import canonical as c
from openacr.mill.config.settings import Settings
from openacr.mill.plan.moves.arcs import along
from openacr.mill.plan.moves.geometry import weights
from openacr.sysvar import Store
from openacr.sysvar.tabs import AXIS, SPEEDS

A = 3
TURN_SPEED, TURN_ACCEL = 90.0, 500.0  # degrees
TURN_PULSES = 10_000.0
SCALES = np.array([PULSES, PULSES, PULSES, TURN_PULSES])
MOST = np.array([[SPEED] * 3 + [TURN_SPEED], [ACCEL] * 3 + [TURN_ACCEL], [JERK] * 4])
ROUNDING = np.array([1e-4, 2e-3, 0.03])  # 24 bits of a position over powers of 4 ms
CELLS = {
    AXIS.configured[A]: 1.0,
    AXIS.home_required[A]: 0.0,
    AXIS.pulses_per_unit[A]: TURN_PULSES,
    AXIS.max_axis_acceleration[A]: TURN_ACCEL,
    SPEEDS.max_rotary_speed: 60.0 * TURN_SPEED,
}


def rotary_shop(**cells: float) -> Shop:
    """A machine in inches that plans its paths, with a table A."""
    own = {f"P{cell}": value for cell, value in CELLS.items()}
    shop = planned_shop(**own | cells)
    shop.card.command("DRIVE ON A", program=0)
    return shop


def table_store(**cells: float) -> Store:
    """The cells of such a machine, all units mm and degrees."""
    store = Store(is_metric=True)
    own = {SPEEDS.path_jerk: JERK, SPEEDS.max_machine_speed: FEED}
    ramps = {SPEEDS.master_feed_acc_dec: ACCEL, SPEEDS.master_rapid_acc_dec: ACCEL}
    pulses = {AXIS.pulses_per_unit[axis]: PULSES for axis in range(A)}
    for cell, value in {**CELLS, **own, **ramps, **pulses}.items():
        store.write(cell, value)
    for name, value in cells.items():
        store.write(int(name.removeprefix("P")), value)
    return store


def to(x: float = 0.0, y: float = 0.0, z: float = 0.0, a: float = 0.0) -> c.Point:
    return (x, y, z, a, 0.0, 0.0, 0.0, 0.0)


BEGIN = to()


def line(number: int, *place: float, feed: float = FEED) -> c.Line:
    return c.Line(src(number), to(*place), c.Pace(feed, tolerance_u=TOLERANCE))


def turned_circle(number: int, feed: float = FEED) -> c.Arc:
    """A full circle of 5 around (9, 0), while the table turns once."""
    pace = c.Pace(feed, tolerance_u=TOLERANCE)
    return c.Arc(src(number), to(4.0, a=360.0), c.Plane.XY, (9.0, 0.0), 2 * math.pi, 5.0, 5.0, pace)


PROGRAMS: dict[str, list[c.Entry]] = {
    "mixed": [
        line(1, 20, 0, 0, 30), line(2, 20, 20, 0, 60), line(3, 20, 20, 0, 90), line(4), end(),
    ],
    "turns": [line(1, 0, 0, 0, 90), line(2, 0, 0, 0, -30), line(3), end()],
    "wave": [
        *(line(k, k / 2, 2 * math.sin(k / 10), 0, 20 * math.sin(k / 20)) for k in range(1, 80)),
        end(),
    ],
    "rapids": [
        line(1, 10, 0, 0, 10), c.Rapid(src(2), to(20, 5, 0, 100)), line(3, 30, 5, 0, 100),
        c.Rapid(src(4), to(30, 5)), line(5, 30, 5, -1, feed=600.0), end(),
    ],
    "circle": [line(1, 4), turned_circle(2), line(3, 4, -10, 0, 360), end()],
}  # fmt: skip


def scales_of(shop: Shop) -> Reals:
    """Pulses per unit of X Y Z A."""
    return np.array([shop.store.read(AXIS.pulses_per_unit[axis]) for axis in range(A + 1)])


def counts(program: Sequence[c.Entry], scales: Reals = SCALES) -> list[float]:
    """Where the last move of a program ends, in pulses."""
    last = next(move for move in reversed(program) if isinstance(move, c.Line | c.Arc))
    return [float(round(value)) for value in np.array(last.end[: A + 1]) * scales]


def follow(shop: Shop, *actions: tuple[float, Action], limit_s: float = 30.0) -> Reals:
    """Where X Y Z A are commanded to stand, tick by tick, with what is done at which second."""
    return recorded(shop, A + 1, actions, limit_s) / scales_of(shop)


def assert_limits(places: Reals, period_s: float) -> None:
    """No axis above its limits, nor the tool above its feed, every 0.5 and every 1 ms."""
    for step_s in (period_s, 0.001):
        every = round(step_s / period_s)
        for phase in range(every):
            for k in (1, 2, 3):
                rates = np.abs(np.diff(places[phase::every], k, axis=0)).max(axis=0) / step_s**k
                assert (rates <= MOST[k - 1] * (1 + ROUNDING[k - 1])).all(), (k, rates)
            steps = np.diff(places[phase::every, :A], axis=0)
            assert np.linalg.norm(steps, axis=1).max() / step_s <= SPEED * (1 + 1e-4)


def polyline(program: Sequence[c.Entry], begin: c.Point = BEGIN) -> Reals:
    """The programmed path as points close to each other."""
    points = [begin]
    for move in program:
        if isinstance(move, c.Arc):
            begin, count = points[-1], math.ceil(move.start_radius * abs(move.sweep_rad) / 0.02)
            points += [along(move, begin, k / count) for k in range(1, count + 1)]
        elif isinstance(move, c.Line):
            points.append(move.end)
    return np.array(points)[:, : A + 1]


def off_path(
    store: Store, places: Reals, program: Sequence[c.Entry], begin: c.Point = BEGIN
) -> float:
    """The largest distance from the programmed path, in the space in which it is planned."""
    factors = np.array(weights(Settings(store))[: A + 1])
    path = polyline(program, begin) * factors
    return off(places * factors, path[:-1], path[1:])
