"""What rules at the knots of a smooth chain: feeds, shares of the limits, what the tube leaves."""

import numpy as np

from openacr.trajectory.course.course import Soft
from openacr.trajectory.path.limits import Limits
from openacr.trajectory.path.sections import Sections
from openacr.trajectory.path.setpoints import Reals
from openacr.trajectory.path.tube import WHOLE, Tube
from openacr.trajectory.speed.window import Rules

JERK_SHARE, ACCELERATION_SHARE = 0.99, 0.99  # of the limits, for what happens between knots
TAIL_SHARE = 0.95  # where a law is planned again
REST_SHARE = 0.938  # of the jerk near rest, where knots are sparse
FEED_SHARE = 0.9997  # for what happens between knots
TURNED_SHARE = 0.9994  # the same for some of the axes: the path turns by TURN_RAD between knots
LEAST_ROOM = 0.01  # of the tolerance, for the B-spline in time
LONG = 0.7  # periods: what takes longer is seen by a single difference of setpoints

Shares = tuple[Reals, ...]  # of squared speed, acceleration and jerk; of the last two in the tail


class KnotRules:
    """The rules at knots; the shares of knots that a window has used before are kept."""

    __slots__ = ("_fast", "_first", "_last", "_limits", "_period_s", "_push", "_rest_u", "_ruling",
                 "_sections", "_soft", "_tail", "_tube", "ease")  # fmt: skip

    def __init__(
        self, limits: Limits, period_s: float, sections: Sections, tube: Tube,
        rest_u: float, first: Soft | None,
    ) -> None:  # fmt: skip
        """`rest_u`: how far from rest knots are sparse; `first`: the start overlaps a chain."""
        self._limits, self._period_s = limits, period_s
        self._ruling = np.array(limits.planned(period_s))
        self._ruling[: limits.axes] *= TURNED_SHARE
        self._sections, self._tube, self._rest_u = sections, tube, rest_u
        self._first = first
        self._last: Soft | None = None
        self._fast = self._push = self._soft = self._tail = np.empty(0)
        self.ease = 1.0  # share of the jerk of new windows

    def close(self, last: Soft) -> None:
        """The chain ends with its tube; there it overlaps another chain, or rests."""
        self._last = last

    def shares(self) -> Shares:
        """The shares of the present knots, to be set again."""
        return self._fast, self._push, self._soft, self._tail

    def set_shares(self, shares: Shares) -> None:
        """Return to shares that ruled before."""
        self._fast, self._push, self._soft, self._tail = shares

    def drop(self, count: int) -> None:
        """Forget the first knots."""
        self.set_shares(tuple(each[count:].copy() for each in self.shares()))

    def fresh(self, knots: Reals) -> Rules:
        """The rules at knots (with two more on each side) that no window has used."""
        inner = knots[2:-2]
        feed, tool, tolerance = self._sections.least(knots[1:-3], knots[3:-1])
        zone = self._zone(inner, self._first)
        soft = np.where(inner < self._rest_u, REST_SHARE, JERK_SHARE)
        if self._last is not None:
            to_end = self._tube.length_u - inner
            zone *= self._zone(to_end, self._last)
            soft[to_end < self._rest_u] = REST_SHARE
        room = self._tube.left_u(knots[1:-3], knots[3:-1]) + (WHOLE - self._tube.share) * tolerance
        normal = 6.0 / self._period_s**2 * np.maximum(room, LEAST_ROOM * tolerance)
        push = np.full(len(inner), ACCELERATION_SHARE)
        return Rules(FEED_SHARE * feed, TURNED_SHARE * tool, np.ones(len(inner)), push,
                     soft * zone * self.ease, zone, normal, self._ruling,
                     LONG * self._period_s)  # fmt: skip

    def next(self, knots: Reals, kept: int, tail_u: float) -> Rules:
        """The rules of the next window; its first `kept` knots keep their shares.

        After `tail_u` the law is not run, but planned again: there it uses TAIL_SHARE of the
        limits, so that it begins the next window at a distance from all of them.
        """
        rules = self.fresh(knots)
        tail = np.where(knots[2:-2] > tail_u, TAIL_SHARE, 1.0)
        rules.fast[:kept] = self._fast[:kept]
        rules.push[:kept] = self._push[:kept] / self._tail[:kept]
        rules.soft[:kept] = self._soft[:kept] / self._tail[:kept]
        np.multiply(rules.push, tail, out=rules.push)
        np.multiply(rules.soft, tail, out=rules.soft)
        self.set_shares((rules.fast, rules.push, rules.soft, tail))
        return rules

    def _zone(self, s: Reals, soft: Soft | None) -> Reals:
        """The share of the jerk limits at distances from an end that overlaps."""
        share = np.ones(len(s))
        if soft is not None and soft.time_s > 0.0:
            share[s < soft.reach_u()] = soft.share
        return share
