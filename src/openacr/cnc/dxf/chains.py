"""Join the pieces of a drawing to chains, give them a direction and an order.

A piece is what one entity of the drawing is: segments that follow each other. Ends of
pieces closer than epsilon are one node. From a piece the chain is followed to the free end
that goes on straightest, until it is back at its first node or nothing is left there.
"""

import math
from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from openacr.cnc.dxf.segments import Point, Segment, reverse_all

Piece = tuple[Segment, ...]
ORIGIN: Point = (0.0, 0.0)
NO_PARENT = -1
REACH = 0.49  # of the length of a piece


@dataclass(frozen=True, slots=True)
class Chain:
    """Segments that follow each other without a gap."""

    segments: tuple[Segment, ...]
    is_closed: bool

    @property
    def start(self) -> Point:
        """Where it begins."""
        return self.segments[0].start

    @property
    def end(self) -> Point:
        """Where it ends."""
        return self.segments[-1].end

    @property
    def length(self) -> float:
        """The length of the chain."""
        return _length(self.segments)

    @property
    def area(self) -> float:
        """The area inside, positive counter-clockwise."""
        return math.fsum(segment.area for segment in self.segments)

    def reversed(self) -> "Chain":
        """The chain in the opposite direction."""
        return Chain(reverse_all(self.segments), self.is_closed)


def joined(pieces: Sequence[Piece], epsilon: float) -> list[Chain]:
    """The chains the pieces make."""
    return Joiner(pieces, epsilon).chains()


def directed(chains: Iterable[Chain], *, is_counter_clockwise: bool) -> list[Chain]:
    """Closed chains in the wanted direction; open ones as they are."""
    return [
        chain.reversed() if chain.is_closed and (chain.area > 0) != is_counter_clockwise else chain
        for chain in chains
    ]


def in_order(
    chains: Sequence[Chain], tool: Point = ORIGIN, parents: Sequence[int] = ()
) -> list[int]:
    """The numbers of the chains by the nearest start; see `turned` for their direction.

    With `parents`, which chain lies around which, a chain comes after all that lie in it.
    """
    inside = Counter(parents)
    ready = [number for number in range(len(chains)) if not inside[number]]
    starts, ends = Nearest(), Nearest()
    for number in ready:
        _offer(number, chains[number], starts, ends)
    ordered: list[int] = []
    while len(ordered) < len(chains):
        (number, to_start), (other, to_end) = starts.to(tool), ends.to(tool)
        number = number if to_start <= to_end else other
        starts.take(number)
        ends.take(number)
        tool = turned(chains[number], tool).end
        ordered.append(number)
        around = parents[number] if parents else NO_PARENT
        if around != NO_PARENT:
            inside[around] -= 1
            if not inside[around]:
                _offer(around, chains[around], starts, ends)
    return ordered


def turned(chain: Chain, tool: Point) -> Chain:
    """An open chain from the end nearest to the tool; a closed one as it is."""
    if chain.is_closed or math.dist(chain.start, tool) <= math.dist(chain.end, tool):
        return chain
    return chain.reversed()


def _offer(number: int, chain: Chain, starts: "Nearest", ends: "Nearest") -> None:
    starts.put(number, chain.start)
    ends.put(number, chain.start if chain.is_closed else chain.end)


class Nearest:
    """Points that come and are taken away one after the other, each with a number.

    Distances are squared: a comparison needs no root. When half of the places are free, the
    rest moves together.
    """

    def __init__(self, points: Iterable[Point] = ()) -> None:
        self._numbers = np.empty(0, dtype=np.intp)
        self._x, self._y = np.empty(0), np.empty(0)
        self._place: dict[int, int] = {}
        self._new: list[tuple[int, Point]] = list(enumerate(points))

    def put(self, number: int, point: Point) -> None:
        """One more point."""
        self._new.append((number, point))

    def to(self, here: Point) -> tuple[int, float]:
        """The nearest one left, and the square of its distance."""
        self._take_in()
        aside, up = self._x - here[0], self._y - here[1]
        squares = aside * aside + up * up
        place = int(squares.argmin())
        return int(self._numbers[place]), float(squares[place])

    def take(self, number: int) -> None:
        """Take one away."""
        self._take_in()
        self._x[self._place.pop(number)] = math.inf
        if 2 * len(self._place) < len(self._x):
            left = np.isfinite(self._x)
            self._numbers = self._numbers[left]
            self._x, self._y = self._x[left], self._y[left]
            self._place = {int(each): place for place, each in enumerate(self._numbers)}

    def _take_in(self) -> None:
        if self._new:
            count = len(self._x)
            self._place.update((n, count + k) for k, (n, _) in enumerate(self._new))
            self._numbers = np.append(self._numbers, [n for n, _ in self._new])
            self._x = np.append(self._x, [point[0] for _, point in self._new])
            self._y = np.append(self._y, [point[1] for _, point in self._new])
            self._new.clear()


class Joiner:
    """The nodes of a drawing, and which pieces are still free.

    End e of piece p is number 2p + e: 0 its start, 1 its end.
    """

    def __init__(self, pieces: Sequence[Piece], epsilon: float) -> None:
        self._pieces = pieces
        self._points = [end for piece in pieces for end in (piece[0].start, piece[-1].end)]
        self._node = nodes_of(pieces, epsilon)
        self._at: dict[int, list[int]] = defaultdict(list)
        for end, node in enumerate(self._node):
            self._at[node].append(end)
        self._free = [self._is_long(piece, epsilon) for piece in range(len(pieces))]

    @property
    def merged_cnt(self) -> int:
        """Pieces shorter than epsilon that begin and end in one joint; before `chains`."""
        return self._free.count(False)

    def chains(self) -> list[Chain]:
        """The chains, from the piece nearest to the origin on."""
        nearest = sorted(range(len(self._pieces)), key=self._from_origin)
        return [self._chain(piece) for piece in nearest if self._free[piece]]

    def _is_long(self, piece: int, epsilon: float) -> bool:
        """Whether a piece does more than join two others inside one node."""
        if self._node[2 * piece] != self._node[2 * piece + 1]:
            return True
        segments = self._pieces[piece]
        return segments[0].is_full or _length(segments) > epsilon

    def _from_origin(self, piece: int) -> float:
        return min(math.dist(self._points[2 * piece + end], ORIGIN) for end in (0, 1))

    def _chain(self, piece: int) -> Chain:
        """The chain around a piece: forward from its end, then backward from its start."""
        self._free[piece] = False
        first = 2 * piece
        forward = self._followed(first + 1, self._node[first])
        run = [first, *forward]
        is_closed = self._node[run[-1] ^ 1] == self._node[first]
        if not is_closed:
            back = self._followed(first, self._node[run[-1] ^ 1])
            run = [end ^ 1 for end in reversed(back)] + run
        return Chain(self._segments(run, is_closed), is_closed)

    def _followed(self, end: int, goal: int) -> list[int]:
        """The ends entered one after the other, continuing after `end`."""
        entered: list[int] = []
        while self._node[end] != goal:
            following = self._straightest(end)
            if following is None:
                break
            self._free[following >> 1] = False
            entered.append(following)
            end = following ^ 1
        return entered

    def _straightest(self, end: int) -> int | None:
        """The free end at the node of `end` that turns least, of equals the nearest."""
        free = [other for other in self._at[self._node[end]] if self._free[other >> 1]]
        out = _away(self._pieces[end >> 1], end & 1)
        here = self._points[end]

        def turn(other: int) -> tuple[float, float]:
            into = _away(self._pieces[other >> 1], other & 1)
            # Both point out of their pieces: straight on means opposite directions.
            cosine = -(out[0] * into[0] + out[1] * into[1])
            return (round(-cosine, 9), math.dist(here, self._points[other]))

        return min(free, key=turn, default=None)

    def _segments(self, run: Sequence[int], is_closed: bool) -> tuple[Segment, ...]:
        """The segments of a run without the gaps: each starts where the one before ends."""
        segments: list[Segment] = []
        for end in run:
            piece = self._pieces[end >> 1]
            for segment in reverse_all(piece) if end & 1 else piece:
                segments.append(segment.moved_to(segments[-1].end) if segments else segment)
        if is_closed:
            last = segments[-1]
            segments[-1] = Segment(last.start, segments[0].start, last.centre, last.sweep_rad)
        return tuple(segments)


def _length(segments: Iterable[Segment]) -> float:
    return math.fsum(segment.length for segment in segments)


def _away(piece: Piece, end: int) -> Point:
    """The direction out of a piece at one of its ends."""
    segment = piece[-1] if end else piece[0]
    x, y = segment.tangent(segment.end if end else segment.start)
    return (x, y) if end else (-x, -y)


def nodes_of(pieces: Sequence[Piece], epsilon: float) -> list[int]:
    """The node of both ends of every piece.

    An end reaches as far as epsilon, but less than half of its own piece: the ends of a short
    piece, and those of a run of short ones, stay apart.
    """
    points = [end for piece in pieces for end in (piece[0].start, piece[-1].end)]
    reach = [min(epsilon, REACH * _length(piece)) for piece in pieces for _ in (0, 1)]
    return clustered(points, epsilon, reach)


def clustered(
    points: Sequence[Point], epsilon: float, reach: Sequence[float] | None = None
) -> list[int]:
    """The node of every point: points closer than epsilon, directly or by way of others.

    With `reach`, by point and no larger than epsilon, two are joined within the smaller of
    theirs. A grid of cells as wide as epsilon keeps the search to the neighbourhood.
    """
    parent = list(range(len(points)))

    def root(node: int) -> int:
        while parent[node] != node:
            parent[node] = parent[parent[node]]
            node = parent[node]
        return node

    cells: dict[tuple[int, int], list[int]] = defaultdict(list)
    for number, (x, y) in enumerate(points):
        column, row = math.floor(x / epsilon), math.floor(y / epsilon)
        for right, up in product((-1, 0, 1), repeat=2):
            for other in cells.get((column + right, row + up), ()):
                near = epsilon if reach is None else min(reach[other], reach[number])
                if math.dist(points[other], (x, y)) <= near:
                    parent[root(other)] = root(number)
        cells[column, row].append(number)
    return [root(number) for number in range(len(points))]
