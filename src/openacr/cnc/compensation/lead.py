"""The way in: what may be wrong with it."""

from math import hypot

from openacr.cnc.compensation.curve_cy import AWAY, AX, AY, BX, BY, T0X, T0Y, X0, X1, Y0, Y1
from openacr.cnc.compensation.rows import Piece, distance, place
from openacr.cnc.compensation.rules import Report
from openacr.views import F64


def begin_lead_in(F: F64, lead: Piece[object], report: Report) -> None:
    """Let it start where the tool is; W311 where it is shorter than the radius."""
    row = lead.row
    F[row + AX] = F[row + X0]
    F[row + AY] = F[row + Y0]
    radius = abs(F[row + AWAY])
    if hypot(F[row + X1] - F[row + X0], F[row + Y1] - F[row + Y0]) < radius:
        report("W311", f"lead-in is shorter than the radius {radius:g}", lead.element)


def end_lead_in(
    F: F64, lead: Piece[object], piece: Piece[object], report: Report, epsilon: float
) -> None:
    """Let it end beside the start of the next element; W312 where it comes from the material."""
    i, j = lead.row, piece.row
    away = F[j + AWAY]
    place(F, j, away)
    F[i + BX], F[i + BY] = F[j + AX], F[j + AY]
    x, y = F[i + X0], F[i + Y0]
    right = (x - F[j + X0]) * F[j + T0Y] - (y - F[j + Y0]) * F[j + T0X]
    nearest = distance(F, j, x, y)
    if (right if away > 0.0 else -right) > epsilon and nearest < abs(away):
        text = f"lead-in crosses the part: it begins {nearest:.6g} from line"
        report("W312", f"{text} {piece.element.source.line}", lead.element)
