"""Chains: sections of the path between stops and sharp corners.

A corner of SHARP_DEG and more is passed by two chains that come to rest in it and overlap in time
(overlap_cy.py); shallower ones are part of a smooth chain. Rapids are chains of their own, from
rest to rest.
"""

import math
from collections import deque
from dataclasses import dataclass, field

from openacr.trajectory.course.course import Soft
from openacr.trajectory.path.segments import Piece, turn_rad

SHARP_DEG = 32.0
STRAIGHT_RAD = 1e-7  # turns below are rounding of the coordinates
MOST_NEAR = 64


@dataclass(frozen=True, slots=True)
class Corner:
    """The end of one chain and the start of the next one (corners.py)."""

    end: Soft
    start: Soft
    longest_s: float  # overlap that may keep the tolerance
    near_u: float  # distance from the vertex within which they overlap


@dataclass(slots=True)
class Chain:
    """Successive pieces that are passed without a stop."""

    pieces: deque[Piece] = field(default_factory=deque)  # not taken by a course yet
    given: list[Piece] = field(default_factory=list)  # taken by one that may still be dropped
    head: list[Piece] = field(default_factory=list)  # the first ones
    tail: deque[Piece] = field(default_factory=lambda: deque(maxlen=MOST_NEAR))  # the last ones
    corner: Corner | None = None  # with the chain before
    length_u: float = 0.0
    is_closed: bool = False  # no piece follows
    stops: bool = True  # comes to rest at its end; else overlaps the next chain
    is_straight: bool = True  # one line at one feed, however many pieces it has

    def add(self, piece: Piece) -> None:
        """Append a piece."""
        if self.tail:
            last, new = self.tail[-1].segment, piece.segment
            self.is_straight &= (
                turn_after(self, piece) <= STRAIGHT_RAD
                and last.feed_ups == new.feed_ups
                and last.tool_ups == new.tool_ups
                and last.fastest == new.fastest
            )
        self.is_straight &= piece.is_line
        self.pieces.append(piece)
        self.tail.append(piece)
        if len(self.head) < MOST_NEAR:
            self.head.append(piece)
        self.length_u += piece.length_u

    def give(self) -> Piece:
        """Remove and return the next piece, for a course."""
        piece = self.pieces.popleft()
        self.given.append(piece)
        return piece

    def take_back(self) -> None:
        """Have all pieces again: the course that took them is dropped."""
        self.pieces.extendleft(reversed(self.given))
        self.given.clear()

    def pieces_within(self, length_u: float) -> list[Piece]:
        """The first of the pieces not taken yet, until they are `length_u` long."""
        found, gone_u = [], 0.0
        for piece in self.pieces:
            found.append(piece)
            gone_u += piece.length_u
            if gone_u >= length_u:
                break
        return found

    @property
    def is_rapid(self) -> bool:
        """Whether this is a rapid."""
        return self.tail[-1].segment.is_rapid

    def takes(self, piece: Piece) -> bool:
        """Whether a piece can be passed into without a stop or an overlap."""
        if not self.tail:
            return True
        if self.is_rapid or piece.segment.is_rapid:
            return False
        return turn_after(self, piece) < math.radians(SHARP_DEG)


def turn_after(chain: Chain, piece: Piece) -> float:
    """The turn from the end of a chain into a piece, rad."""
    last = chain.tail[-1]
    return turn_rad(last.tangent(last.length_u), piece.tangent(0.0))
