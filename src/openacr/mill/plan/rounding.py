"""Corners rounded within a path tolerance, for the planner and the prediction.

The card plans such corners itself (kernel/path/round_law_cy.py); its result is computed here
by the same functions: a corner is entered and left within `reach_u` of the programmed one, and its
two halves are passed at a constant acceleration each.
"""

import math
from dataclasses import dataclass

from openacr.compiled import pick
from openacr.kernel.path import round_law_cy

Direction = tuple[float, ...]
NO_JERK = 0.0
REACH = 4.0  # per tolerance and change of direction

_cap = pick(round_law_cy.round_cap)
_ramp2 = pick(round_law_cy.round_ramp2)
_brake = pick(round_law_cy.round_brake)


@dataclass(frozen=True, slots=True)
class Corner:
    """A rounded corner: the size of its turn, its reach along the path, its limits."""

    turn: float  # length of the difference of the two unit tangents
    reach_u: float
    cap_ups: float
    ramp_ups2: float  # of the weaker of the two moves

    @classmethod
    def between(
        cls, before: Direction, after: Direction, tolerance_u: float, shorter_u: float, ramp: float
    ) -> "Corner | None":
        """The corner between two straight moves, the shorter `shorter_u` long; None: straight."""
        turn = math.dist(before, after)
        if turn <= round_law_cy.STRAIGHT:
            return None
        reach = min(REACH * tolerance_u / turn, 0.5 * shorter_u)
        return cls(turn, reach, _cap(turn, reach, ramp, NO_JERK), ramp)

    def before2(self, w: float) -> float:
        """The highest squared speed at one end of a half whose other end has `w`."""
        return min(_ramp2(self.turn, self.reach_u, self.ramp_ups2, NO_JERK, w), self.cap_ups**2)

    def pass2(self, w: float, goal: float) -> float:
        """The squared speed after a half entered with `w` that may end with `goal`."""
        if goal <= w:
            return goal
        top = min(goal, _ramp2(self.turn, self.reach_u, self.ramp_ups2, NO_JERK, w))
        rate = _brake(self.turn, self.reach_u, self.ramp_ups2, top)
        return min(top, w + 2.0 * rate * self.reach_u)
