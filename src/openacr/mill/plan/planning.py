r"""Look-ahead planning of the speed from one move to the next.

The card plans inside a move; what it cannot see is the corner after the last move it was
sent. So every move is sent with the speed it has to end with (FVEL), and that speed is
planned here over the moves that are known:

    corner     the lower feed, slowed by the angle between the tangents (G62), by the
               velocity step an axis would make there (Corner Step), 0 for exact stops
    backward   v_end(i)^2 <= v_end(i+1)^2 + 2 A L(i+1), the last known move ends at rest

The backward pass limits each speed to one that the following moves can brake from. It only
rises when more moves become known, so a move that was sent stays valid.

Moves with a path tolerance are joined: the card rounds the corner between them and computes its
speeds itself. Here the same speeds are predicted, for the moves around them and the run time.
"""

import math
from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Generic, TypeVar

from openacr.cnc.canonical import PathMode
from openacr.errors import UserError
from openacr.mill.config.tabs import Speeds
from openacr.mill.plan.rounding import Corner, Direction

MOST_AHEAD = 4000  # moves held back at most, however short they are


@dataclass(frozen=True, slots=True)
class CornerRules:
    """Corner settings of the CONTROL and SPEEDS tabs; speeds in units/s."""

    angle1_deg: float = 0.0
    angle2_deg: float = 0.0
    slowest_ups: float = 0.0
    step_ups: float = 0.0  # largest velocity step of one axis, 0 = any

    @classmethod
    def of(cls, speeds: Speeds) -> "CornerRules":
        """The rules of a machine."""
        return cls(speeds.angle1_deg, speeds.angle2_deg, speeds.corner_ups, speeds.corner_step_ups)

    def __post_init__(self) -> None:
        if self.angle2_deg and self.angle2_deg < self.angle1_deg:
            raise UserError(
                f"Acute Angle2 {self.angle2_deg} is below Acute Angle1 {self.angle1_deg}"
            )


@dataclass(slots=True, kw_only=True)
class PlannedMove:
    """One move in the planner; `start`/`end` are None where no linear axis moves."""

    length_u: float
    feed_ups: float
    ramp_ups2: float
    start: Direction | None
    end: Direction | None
    turns: Direction = ()  # what rotary axes turn by length, a degree as a length
    mode: PathMode = PathMode.FREE
    is_rapid: bool = False
    tolerance_u: float = 0.0  # of the corner at its end, towards another move with one
    is_joined: bool = False  # rounded into the next move by the card
    corner: Corner | None = None  # rounded corner at its end; None is straight on
    corner_ups: float = 0.0  # highest speed at its end, regardless of later moves
    exit_ups: float = 0.0  # speed at its end


def turn_deg(before: Direction, after: Direction) -> float:
    """The angle between two unit tangents in degrees, 0 straight on, 180 reversal.

    atan2 of the half-angle chords keeps full accuracy near 0 and 180, where acos of the
    dot product loses half the digits.
    """
    apart = math.sqrt(sum((a - b) ** 2 for a, b in zip(before, after, strict=True)))
    along = math.sqrt(sum((a + b) ** 2 for a, b in zip(before, after, strict=True)))
    return math.degrees(2.0 * math.atan2(apart, along))


def _by_angle(turn: float, feed_ups: float, rules: CornerRules) -> float:
    """The corner speed of G62: feed up to angle 1, then linearly to the slowest, 0 from angle 2."""
    first, second = rules.angle1_deg, rules.angle2_deg
    if (first == 0.0 and second == 0.0) or turn <= first:
        return feed_ups
    if second > 0.0 and turn >= second:
        return 0.0
    slowest = min(rules.slowest_ups, feed_ups)
    return feed_ups - (feed_ups - slowest) * (turn - first) / ((second or 180.0) - first)


def _by_step(before: Direction, after: Direction, rules: CornerRules) -> float:
    """The speed at which the velocity step of every axis is within Corner Step."""
    jump = max(abs(a - b) for a, b in zip(before, after, strict=True))
    return rules.step_ups / jump if jump > 0.0 else math.inf


def corner_speed(before: PlannedMove, after: PlannedMove, rules: CornerRules) -> float:
    """The highest speed at which one move may pass into the next, units/s."""
    if before.is_rapid or after.is_rapid or before.mode is PathMode.EXACT:
        return 0.0
    if before.end is None or after.start is None:
        return 0.0
    feed_ups = min(before.feed_ups, after.feed_ups)
    if before.mode is PathMode.CORNER:
        feed_ups = _by_angle(turn_deg(before.end, after.start), feed_ups, rules)
    if rules.step_ups <= 0.0:
        return feed_ups
    return min(
        feed_ups, _by_step((*before.end, *before.turns), (*after.start, *after.turns), rules)
    )


def join(before: PlannedMove, after: PlannedMove, rules: CornerRules) -> None:
    """Set the corner between two moves: its speed limit, and whether it is rounded."""
    before.corner, before.is_joined = None, False
    if before.end is None or after.start is None or not before.tolerance_u or not after.tolerance_u:
        before.corner_ups = corner_speed(before, after, rules)
        return
    before.is_joined = True
    before.corner_ups = min(before.feed_ups, after.feed_ups)
    shorter = min(before.length_u, after.length_u)
    ramp = min(before.ramp_ups2, after.ramp_ups2)
    corner = Corner.between(before.end, after.start, before.tolerance_u, shorter, ramp)
    if corner is not None:
        before.corner = corner
        before.corner_ups = min(before.corner_ups, corner.cap_ups)


@dataclass(frozen=True, slots=True)
class SquaredSpeeds:
    """Highest squared speeds of a move: at its start, and between its entry and exit corners."""

    start: float
    line: float
    ahead: float


def backward_pass(move: PlannedMove, entry_corner: Corner | None) -> SquaredSpeeds:
    """Compute the backward pass through one move, from the speed it ends with."""
    top, ramp = move.feed_ups**2, move.ramp_ups2
    ahead = min(move.exit_ups**2, top)
    shape = move.length_u
    if move.corner is not None:
        ahead = min(move.corner.before2(ahead), top)
        shape -= move.corner.reach_u
    if entry_corner is None:
        line = ahead + 2.0 * ramp * shape
        return SquaredSpeeds(line, line, ahead)
    line = min(ahead + 2.0 * ramp * (shape - entry_corner.reach_u), top, entry_corner.cap_ups**2)
    return SquaredSpeeds(entry_corner.before2(line), line, ahead)


Moves = TypeVar("Moves", bound=PlannedMove)


def _brake_u(move: PlannedMove) -> float:
    """The distance to brake from the feed of a move to rest; longer through rounded corners."""
    return move.feed_ups**2 / ((1.0 if move.tolerance_u else 2.0) * move.ramp_ups2)


class Planner(Generic[Moves]):
    """Queue of moves that plans the end speed of each."""

    def __init__(self, rules: CornerRules, least_ahead: int = 0) -> None:
        self._rules = rules
        self._least_ahead = least_ahead
        self._moves: deque[Moves] = deque()
        self._brakes: deque[float] = deque()  # longest braking distances from each move on

    def __len__(self) -> int:
        return len(self._moves)

    def __iter__(self) -> Iterator[Moves]:
        return iter(self._moves)

    def add(self, move: Moves) -> None:
        """Append a move."""
        if self._moves:
            join(self._moves[-1], move, self._rules)
        move.corner, move.is_joined = None, False
        self._moves.append(move)
        distance_u = _brake_u(move)
        while self._brakes and self._brakes[-1] < distance_u:
            self._brakes.pop()
        self._brakes.append(distance_u)

    def _pop_first(self) -> Moves:
        """Remove the first move, and the longest braking distance if it was its own."""
        move = self._moves.popleft()
        if self._brakes[0] == _brake_u(move):
            self._brakes.popleft()
        return move

    def ready(self) -> int:
        """The count of moves that may be sent although more will follow."""
        return len(self._moves) - self._ahead() if self._moves else 0

    def release(self, room: int, *, is_complete: bool) -> Iterator[Moves]:
        """Remove and yield at most `room` moves that may be sent now.

        `is_complete`: no move follows for the moment; the last one ends at rest, and all may
        be sent.
        """
        if not self._moves or room <= 0:
            return
        self._plan()
        count = len(self._moves) if is_complete else len(self._moves) - self._ahead()
        for _ in range(min(room, count)):
            yield self._pop_first()

    def clear(self) -> list[Moves]:
        """Remove and return all moves."""
        moves = list(self._moves)
        self._moves.clear()
        self._brakes.clear()
        return moves

    def _plan(self) -> None:
        """Run the backward pass over all queued moves."""
        after: Moves | None = None
        for move in reversed(self._moves):
            move.exit_ups = 0.0
            if after is not None:
                if after.corner is None and move.corner is None:  # moves come by the thousand
                    start2 = after.exit_ups**2 + 2.0 * after.ramp_ups2 * after.length_u
                else:
                    start2 = backward_pass(after, move.corner).start
                reach = math.sqrt(start2)
                move.exit_ups = min(move.corner_ups, reach)
            after = move

    def _ahead(self) -> int:
        """The count of last moves that have to wait for the moves that follow.

        As many as needed to brake to rest, so that the speeds of released moves do not depend
        on unknown moves; never fewer than `least_ahead`.
        """
        brake_u, distance_u = self._brakes[0], 0.0
        for count, move in enumerate(reversed(self._moves), start=1):
            distance_u += move.length_u
            if distance_u >= brake_u and count >= self._least_ahead:
                return count
            if count >= MOST_AHEAD:
                return count
        return len(self._moves)
