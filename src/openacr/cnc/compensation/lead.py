"""The lead-in, and what may be wrong with it."""

from math import cos, hypot, radians

from openacr.cnc.compensation.curve_cy import (
    AWAY,
    AX,
    AY,
    BX,
    BY,
    SWEEP,
    T0X,
    T0Y,
    T1X,
    T1Y,
    X0,
    X1,
    Y0,
    Y1,
)
from openacr.cnc.compensation.rows import Piece, distance, place
from openacr.cnc.compensation.rules import Report
from openacr.views import F64

ON_COURSE = cos(radians(45.0))


def begin_lead_in(F: F64, lead: Piece[object]) -> None:
    """Let the lead-in start where the tool is."""
    row = lead.row
    F[row + AX] = F[row + X0]
    F[row + AY] = F[row + Y0]


def end_lead_in(
    F: F64, lead: Piece[object], piece: Piece[object], report: Report, epsilon: float
) -> None:
    """Let the lead-in end beside the start of the next element.

    W311 where it is shorter than the radius, unless it runs on into an arc of approach. W312
    where it comes from the material.
    """
    i, j = lead.row, piece.row
    away = F[j + AWAY]
    if hypot(F[i + X1] - F[i + X0], F[i + Y1] - F[i + Y0]) < abs(away) and not _runs_on(F, i, j):
        report("W311", f"lead-in is shorter than the radius {abs(away):g}", lead.element)
    place(F, j, away)
    F[i + BX], F[i + BY] = F[j + AX], F[j + AY]
    x, y = F[i + X0], F[i + Y0]
    right = (x - F[j + X0]) * F[j + T0Y] - (y - F[j + Y0]) * F[j + T0X]
    nearest = distance(F, j, x, y)
    if (right if away > 0.0 else -right) > epsilon and nearest < abs(away):
        text = f"lead-in crosses the part: it begins {nearest:.6g} from line"
        report("W312", f"{text} {piece.element.source.line}", lead.element)


def _runs_on(F: F64, i: int, j: int) -> bool:
    """Whether an arc follows that the lead-in runs into within 45 degrees.

    The arc brings the tool to the part: nothing is cut before its start.
    """
    course = F[i + T1X] * F[j + T0X] + F[i + T1Y] * F[j + T0Y]
    return F[j + SWEEP] != 0.0 and course >= ON_COURSE
