"""Which axes moved and which programs ran, as a picture of the history shows them."""

from bisect import bisect_left, bisect_right
from dataclasses import dataclass, field

from openacr.client.program_states import PROGRAMS
from openacr.controller import Controller
from openacr.map.rows import axes
from openacr.map.words import pf

LOOK_S = 0.02  # of card time from one look to the next
MOST_CHANGES = 20_000  # of one branch; of more, the oldest are forgotten
SETPOINTS = list(axes.primary_setpoint)
AXES = range(len(SETPOINTS))
STATES = list(pf.word)


@dataclass(frozen=True, slots=True)
class Lane:
    """When an axis moved or a program ran: spans in ticks, the end not included."""

    kind: str  # axis or program
    number: int
    spans: list[tuple[int, int]]


@dataclass(slots=True)
class _Course:
    """The changes of one branch: what moves and runs from a tick on, a bit for each lane."""

    ticks: list[int] = field(default_factory=list)
    masks: list[int] = field(default_factory=list)
    end: int = 0  # the latest look

    def note(self, since: int, mask: int, tick: int) -> None:
        """From one tick to another this moves and runs."""
        if since > self.end:  # nothing is known of what was between
            self._add(self.end, 0)
        self._add(since, mask)
        self.end = tick

    def _add(self, tick: int, mask: int) -> None:
        if mask == (self.masks[-1] if self.masks else 0):
            return
        self.ticks.append(tick)
        self.masks.append(mask)
        if len(self.ticks) > MOST_CHANGES:
            del self.ticks[: MOST_CHANGES // 2], self.masks[: MOST_CHANGES // 2]

    def until(self, tick: int) -> "_Course":
        """What was noted before a tick."""
        count = bisect_left(self.ticks, tick)
        return _Course(self.ticks[:count], self.masks[:count], min(self.end, tick))


class Lanes:
    """What has moved and run on each branch of the history of a card."""

    def __init__(self, card: Controller) -> None:
        self._card = card
        self._every_tk = max(1, round(LOOK_S / card.period_s))
        self._courses: dict[int, _Course] = {}
        self._seen: tuple[int, int, list[float]] = (-1, 0, [])  # branch, tick, setpoints

    def look(self, branch: int) -> None:
        """Note what has moved since the last look, and what runs; where it is time for it."""
        tick = self._card.lived_tk
        before, since, places = self._seen
        if before == branch and tick - since < self._every_tk:
            return
        setpoints = self._setpoints()
        self._seen = branch, tick, setpoints
        if before != branch:
            return
        mask = 0
        for axis in AXES:
            mask |= (setpoints[axis] != places[axis]) << axis
        for program in PROGRAMS:
            runs = bool(int(self._card.memory.read(STATES[program])) & pf.PROGRAM_RUNNING)
            mask |= runs << len(AXES) + program
        self._courses.setdefault(branch, _Course()).note(since, mask, tick)

    def _setpoints(self) -> list[float]:
        return [self._card.memory.read(row) for row in SETPOINTS]

    def fork(self, parent: int, branch: int, tick: int) -> None:
        """Another branch has begun: it shares what was before."""
        self._courses[branch] = self._courses.get(parent, _Course()).until(tick)
        self._seen = branch, tick, self._setpoints()

    def forget(self, branch: int) -> None:
        """Forget a branch."""
        self._courses.pop(branch, None)

    def between(
        self, branch: int, first: int, last: int, hidden: frozenset[int] = frozenset()
    ) -> list[Lane]:
        """The lanes in which something happens from a tick to another, without some programs.

        Spans that are nearer to each other than a thousandth of this are one.
        """
        course = self._courses.get(branch, _Course())
        begin = max(0, bisect_right(course.ticks, first) - 1)
        end = bisect_left(course.ticks, last)
        if begin >= end:
            return []
        ends = [*course.ticks[begin + 1 : end], min(last, course.end)]
        parts = [
            (max(first, since), until, mask)
            for since, until, mask in zip(
                course.ticks[begin:end], ends, course.masks[begin:end], strict=True
            )
            if until > first
        ]
        near = (last - first) // 1000
        lanes = []
        for place in range(len(AXES) + len(PROGRAMS)):
            number = place - len(AXES)
            spans: list[tuple[int, int]] = []
            for since, until, mask in parts:
                if not mask >> place & 1 or number in hidden:
                    continue
                if spans and since - spans[-1][1] <= near:
                    since = spans.pop()[0]
                spans.append((since, until))
            if spans:
                kind = "axis" if number < 0 else "program"
                lanes.append(Lane(kind, place if number < 0 else number, spans))
        return lanes
