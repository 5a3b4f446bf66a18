"""Plays an action: runs its steps as far as the card lets them, and counts time-outs."""

from math import inf

from openacr.mill.card.actions import Steps, Until
from openacr.mill.card.alarms import AlarmError
from openacr.mill.card.driver import CardState


class ActionPlayer:
    """What is being done at the moment, if anything."""

    def __init__(self) -> None:
        self._steps: Steps | None = None
        self._until: Until | None = None
        self._waited_s = 0.0

    @property
    def is_active(self) -> bool:
        """Whether something is being done."""
        return self._steps is not None

    @property
    def reason(self) -> str:
        """What is waited for."""
        return self._until.reason if self._until else ""

    @property
    def left_s(self) -> float:
        """How long the wait may take still; infinite where nothing is waited for."""
        return max(self._until.limit_s - self._waited_s, 0.0) if self._until else inf

    def begin(self, steps: Steps) -> None:
        """Do this next; what was being done is broken off."""
        try:
            self.close()
        finally:
            self._steps = steps

    def close(self) -> None:
        """Break off; the action puts back what it has to."""
        steps, self._steps, self._until = self._steps, None, None
        self._waited_s = 0.0
        if steps is not None:
            steps.close()

    def play(self, sample: CardState, step_s: float) -> None:
        """Go on as far as possible; `is_active` is False afterwards when it is done."""
        steps = self._steps
        if steps is None:
            return
        self._waited_s += step_s
        try:
            while self._until is None or self._is_over(self._until, sample):
                self._until, self._waited_s = next(steps), 0.0
        except StopIteration:
            self._forget(steps)
        except BaseException:
            self._forget(steps)
            raise

    def _forget(self, steps: Steps) -> None:
        """These steps have ended; if they began others, those stay."""
        if self._steps is steps:
            self._steps, self._until = None, None

    def _is_over(self, until: Until, sample: CardState) -> bool:
        """Whether a wait has ended; one that took too long is an alarm, if it has one."""
        if until.is_met(sample):
            return True
        if self._waited_s < until.limit_s:
            return False
        if until.alarm is not None:
            raise AlarmError(until.alarm, until.reason)
        return True
