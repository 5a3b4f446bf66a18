"""Findings about elements that the tool cannot reach."""

from itertools import pairwise
from math import copysign

from openacr.cnc.compensation.curve_cy import AWAY, GOUGES, RADIUS
from openacr.cnc.compensation.join_cy import APART
from openacr.cnc.compensation.rows import Piece, Table, fit, join, place
from openacr.cnc.compensation.rules import Report, Rules

HALVINGS = 24


def report_small(report: Report, piece: Piece[object], table: Table, rules: Rules) -> None:
    """Report an arc that the tool does not fit into."""
    radius, away = table.F[piece.row + RADIUS], abs(table.F[piece.row + AWAY])
    text = f"arc of radius {radius:g} is not larger than the tool radius {away:g}"
    if rules.gouge_stop:
        report("E320", text, piece.element)
    else:
        report("W320", f"geometry adjusted: {text}, left out", piece.element)


def report_apart(report: Report, piece: Piece[object], after: Piece[object], table: Table) -> None:
    """Report two elements whose tool paths do not meet."""
    line, away = after.element.source.line, abs(table.F[piece.row + AWAY])
    report("E321", f"no intersection with line {line} at radius {away:g}", piece.element)


def gouge_text(
    table: Table,
    before: Piece[object] | None,
    piece: Piece[object],
    after: Piece[object] | None,
    rules: Rules,
) -> str:
    """The text of a gouge: the line, the radius, and the largest that would fit."""
    line, away = piece.element.source.line, abs(table.F[piece.row + AWAY])
    largest = largest_radius(table, before, piece, after, rules)
    return (
        f"gouge: line {line} cannot be reached with radius {away:g} (largest radius {largest:.5g})"
    )


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
    rows = [row for row in (h, i, j) if row is not None]

    def is_reached(radius: float) -> bool:
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
