"""Entities that were drawn twice: one of them is enough."""

import math
from collections.abc import Sequence

from openacr.cnc.dxf.chains import REACH, Piece, nodes_of
from openacr.cnc.dxf.segments import Point


def without_doubles(pieces: Sequence[Piece], epsilon: float) -> list[Piece]:
    """The pieces without those that lie on another one, in the same or the other direction.

    Alike are pieces with the same two nodes whose lengths and middles differ by no more than
    epsilon, or half of their length where that is less.
    """
    node = nodes_of(pieces, epsilon)
    kept: list[Piece] = []
    by_nodes: dict[tuple[int, int], list[tuple[float, Point]]] = {}
    for number, piece in enumerate(pieces):
        first, last = sorted((node[2 * number], node[2 * number + 1]))
        length = math.fsum(segment.length for segment in piece)
        middle = _middle(piece, length)
        near = min(epsilon, REACH * length)
        others = by_nodes.setdefault((first, last), [])
        if any(
            abs(length - other) <= near and math.dist(middle, place) <= near
            for other, place in others
        ):
            continue
        others.append((length, middle))
        kept.append(piece)
    return kept


def _middle(piece: Piece, length: float) -> Point:
    """The point at half of the length."""
    left = 0.5 * length
    for segment in piece:
        if left <= segment.length:
            return segment.at(left / segment.length)
        left -= segment.length
    return piece[-1].end
