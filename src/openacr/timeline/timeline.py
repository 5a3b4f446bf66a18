"""The timeline of a card: go back to any moment, and on from there.

The state of a card depends on its inputs and their ticks alone. A timeline notes the inputs
and keeps the whole state every few simulated seconds; any other moment is reached by living
through the time since the latest keyframe again. An input at a moment in the past begins
another branch; the branch that was left remains as it is.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import takewhile
from pathlib import Path

from openacr.errors import UserError
from openacr.timeline.branch import Branch
from openacr.timeline.course import Course
from openacr.timeline.keyframe import Keyframe
from openacr.timeline.moment import Moment, moments
from openacr.timeline.noted import Noted


class Timeline(Noted):
    """The past and the branches of a card; `card` is the card at the present moment.

    Time goes on by `advance`; everything else is done with the card itself. Connections are
    part of the state: at a moment before a host has connected, its stream does not exist.
    """

    # back

    def seek(self, moment: Moment | int) -> None:
        """Go to any moment of the present branch; UserError for one that it does not have.

        What programs print meanwhile is not heard, and what waits to be sent is dropped.
        """
        self._reach()
        moment = Moment(moment) if isinstance(moment, int) else moment
        self._require(self.branch, moment)
        with self.card.undisturbed():
            self._return_to(self.branch.keyframe(moment), unless_before=moment)
            self._live_to(moment)
        self.card.streams.discard_output()

    def _require(self, branch: Branch, moment: Moment) -> None:
        first, last = branch.first, branch.last
        if not first.order <= moment.order <= last.order:
            raise UserError(
                f"tick {moment.tick} is not on branch {branch.number}, which goes from"
                f" {first.tick} to {last.tick}"
            )

    def _return_to(self, keyframe: Keyframe, *, unless_before: Moment) -> None:
        """Take over a keyframe, unless the present is between it and the moment."""
        if Moment(keyframe.tick).order <= self.now.order <= unless_before.order:
            return
        self.card.take_over(keyframe.snapshot)
        self._entered = keyframe.entered

    def _live_to(self, moment: Moment) -> None:
        branch = self.branch
        place = self._entered - branch.forgotten
        due = takewhile(lambda each: each[0].order <= moment.order, moments(branch.entries, place))
        for _, place in due:
            self._player.play(branch.entries[place])
            self._entered += 1
        self._player.advance_within(moment.tick, moment.within)

    def seek_stop(self, counts: Callable[[], bool] = lambda: True) -> bool:
        """Go back to the last moment at which an event would have ended `advance`.

        Events are those of the watches, the poll and the announced lines that are set now, if
        `counts` says so there. If there is none, the card is at its first moment and the answer
        is False.
        """
        end = self.now
        for keyframe in reversed(self.branch.keyframes):
            if Moment(keyframe.tick).order >= end.order:
                continue
            found = self._last_stop(keyframe, end, counts)
            if found is not None:
                self.seek(found)
                return True
            end = Moment(keyframe.tick)
        self.seek(self.branch.first)
        return False

    def _last_stop(
        self, keyframe: Keyframe, end: Moment, counts: Callable[[], bool]
    ) -> Moment | None:
        self.seek(keyframe.tick)
        found = None
        while self.now.order < end.order:
            ended = self.advance(end.tick - self.card.lived_tk)
            if ended and self.now.order < end.order and counts():
                found = self.now
        return found

    # branches

    def switch(self, number: int) -> None:
        """Go to the last moment of another branch; UserError for one that does not exist."""
        branch = self.branches.named(number)
        self._reach()
        self.branch = branch
        with self.card.undisturbed():
            keyframe = self.branch.keyframe(self.branch.last)
            self.card.take_over(keyframe.snapshot)
            self._entered = keyframe.entered
            self._live_to(self.branch.last)
        self.card.streams.discard_output()

    def drop(self, number: int) -> None:
        """Forget a branch; UserError for the present one and for one that does not exist."""
        branch = self.branches.named(number)
        if branch is self.branch:
            raise UserError(f"branch {number} is the present one: change to another one first")
        self.branches.remove(branch)

    def course(
        self, number: int, first_tk: int | None = None, last_tk: int | None = None
    ) -> Course:
        """A branch as plain data, from the latest keyframe before one tick up to another.

        Without ticks, all of it; UserError for a branch or a tick that does not exist.
        """
        self._reach()
        branch = self.branches.named(number)
        first = branch.first if first_tk is None else Moment(first_tk)
        last = branch.last if last_tk is None else Moment(last_tk)
        for moment in (first, last):
            self._require(branch, moment)
        return Course.of(self.card, branch, first, last)

    def save(self, path: Path, *, seen: Callable[[float], None] = lambda part: None) -> None:
        """Write the present branch as a journal; `seen` gets the part that is done, 0 to 1."""
        self.course(self.branch.number).save(path, seen=seen)
