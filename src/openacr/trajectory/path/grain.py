"""How finely a chain is planned (samples of its path, knots of its speed), and how far ahead."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from openacr.trajectory.path.limits import Along, Limits
from openacr.trajectory.path.segments import Piece
from openacr.trajectory.path.tube import STEP

PER_RADIUS = 10.0  # samples on the radius of an arc, at least
LEAST_STEPS = 32  # samples of the shortest chain
KNOT = 2.0  # samples between two knots where the path bends
LOOK = 2.5  # braking distances ahead of what is committed


@dataclass(frozen=True, slots=True)
class Grain:
    """The sampling of a chain, from what is known of it when it begins.

    `along` are its limits at the start at its highest feed, `across_ups2` the acceleration with
    which it can leave its pieces, `time_s` the time between two knots near rest.
    """

    along: Along
    tolerance_u: float
    across_ups2: float
    step_u: float  # between two samples
    dense_u: float  # between two knots where the path bends
    time_s: float
    piece_u: float  # mean length of the known pieces


def grain_of(limits: Limits, period_s: float, known: Sequence[Piece]) -> Grain:
    """The grain of a chain of which some pieces are known."""
    tolerance = min(piece.segment.tolerance_u for piece in known)
    feed = max(piece.feed_ups for piece in known)
    along = limits.along(known[0].tangent(0.0), feed, period_s)
    corner_s = max(0.1 * (48.0 * tolerance / along.jerk) ** (1 / 3), 0.5 * period_s)
    time_s = min(corner_s, max(along.acceleration / along.jerk / 16.0, 0.5 * period_s))
    radius = min((p.radius_u for p in known if not p.is_line), default=math.inf)
    length = sum(piece.length_u for piece in known)
    step = min(
        STEP * tolerance,
        0.2 * corner_s * along.speed,
        radius / PER_RADIUS,
        length / LEAST_STEPS,
    )
    across = max(limits.acceleration_ups2)
    if not math.isfinite(radius):  # corners are passed at J/2 (48 e/J)^(1/3)
        jerk = max(limits.jerks(period_s))
        across = min(across, 0.5 * jerk * (48.0 * tolerance / jerk) ** (1 / 3))
    return Grain(along, tolerance, across, step, KNOT * step, time_s, length / len(known))


def look_ahead(along: Along) -> float:
    """The length of path to be planned after what is committed: some braking distances."""
    brake = along.speed**2 / (2.0 * along.acceleration)
    return LOOK * (brake + along.speed * along.acceleration / (2.0 * along.jerk))
