"""The order of moves and planned curves: sections, one after the other.

Moves that the card plans (`Planner`) and moves that are planned as one curve (`PlannedPath`)
follow each other at rest. A rapid belongs to the section it comes in.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from typing import TYPE_CHECKING

from openacr.mill.config.curves import can_plan
from openacr.mill.config.settings import Settings
from openacr.mill.plan.moves.encoding import Job
from openacr.mill.plan.moves.planning import CornerRules, Planner

if TYPE_CHECKING:
    from openacr.mill.plan.curves.planned_path import PlannedPath

ENOUGH = 1 << 30  # moves: no more have to be read
AHEAD_S = 3.0  # of motion at the programmed feeds, known to the plan of a curve


class Route:
    """The moves that were read and are not sent, in sections of one kind."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._can_plan = can_plan(settings)
        self._sections: deque[Planner[Job] | PlannedPath] = deque([self._moves()])
        self._is_planned = settings.speeds.path_tolerance_u > 0.0  # the kind of the first rapids
        self._ahead_s = 0.0

    def _moves(self) -> Planner[Job]:
        return Planner(CornerRules.of(self._settings.speeds), self._settings.forward_threshold)

    def _planned(self) -> PlannedPath:
        from openacr.mill.plan.curves.planned_path import (
            PlannedPath,  # loads numpy: most runs have none
        )

        return PlannedPath(self._settings)

    def add(self, job: Job) -> None:
        """Append a move to the last section, or begin another one with it."""
        if self._can_plan and not job.is_rapid:
            self._is_planned = job.path_tolerance_u > 0.0
        is_planned = self._can_plan and self._is_planned
        last = self._sections[-1]
        if isinstance(last, Planner) is is_planned:
            if not len(last) and len(self._sections) == 1 and not self._is_open(last):
                self._sections.pop()
            last = self._planned() if is_planned else self._moves()
            self._sections.append(last)
        last.add(job)

    @staticmethod
    def _is_open(section: Planner[Job] | PlannedPath) -> bool:
        return not isinstance(section, Planner) and section.is_open

    @property
    def curve(self) -> PlannedPath | None:
        """The curve that is sent now, None while moves are sent."""
        head = self._sections[0]
        return None if isinstance(head, Planner) else head

    @property
    def has_more(self) -> bool:
        """Whether another section follows the present one."""
        return len(self._sections) > 1

    def go_on(self) -> None:
        """Go on to the next section, if the present one is done and the machine at rest."""
        while self.has_more and not len(self._sections[0]):
            self._sections.popleft()

    def ready(self) -> int:
        """The count of moves that may be sent although more will follow."""
        head = self._sections[0]
        if self.has_more:
            return ENOUGH
        if not isinstance(head, Planner):
            return ENOUGH if head.known_s >= AHEAD_S else 0
        return head.ready()

    def release(self, room: int, *, is_complete: bool) -> Iterator[Job]:
        """Remove and yield at most `room` moves that may be sent now; those of a curve never."""
        head = self._sections[0]
        if isinstance(head, Planner):
            yield from head.release(room, is_complete=is_complete or self.has_more)

    def __len__(self) -> int:
        return sum(map(len, self._sections))

    def __iter__(self) -> Iterator[Job]:
        for section in self._sections:
            yield from section

    def clear(self) -> list[Job]:
        """Remove and return all moves."""
        jobs = [job for section in self._sections for job in section.clear()]
        self._sections = deque([self._moves()])
        return jobs
