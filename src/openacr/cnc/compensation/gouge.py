"""The largest tool that reaches an element between its neighbours."""

from itertools import pairwise
from math import copysign

from openacr.cnc.compensation.curve_cy import AWAY, GOUGES
from openacr.cnc.compensation.join_cy import APART
from openacr.cnc.compensation.rows import Piece, Table, fit, join, place
from openacr.cnc.compensation.rules import Rules

HALVINGS = 24


def largest_radius(
    table: Table,
    before: Piece[object] | None,
    piece: Piece[object],
    after: Piece[object] | None,
    rules: Rules,
) -> float:
    """Find the radius by bisection; 0 where even the smallest tool does not get through."""
    F = table.F
    side = copysign(1.0, F[piece.row + AWAY])
    i = table.scratch(1, piece.row)
    h = None if before is None or before.is_lead_in else table.scratch(0, before.row)
    j = None if after is None else table.scratch(2, after.row)

    def is_reached(radius: float) -> bool:
        rows = [row for row in (h, i, j) if row is not None]
        has_room = [place(F, row, side * radius) for row in rows]
        if not all(has_room):
            return False
        meets = [
            join(F, first, second, rules.epsilon, rules.root, False)
            for first, second in pairwise(rows)
        ]
        return APART not in meets and fit(F, i, rules.epsilon, rules.sweep_epsilon) != GOUGES

    low, high = 0.0, abs(F[piece.row + AWAY])
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if is_reached(middle) else (low, middle)
    return low
