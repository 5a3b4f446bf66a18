"""Execution of actions: runs the steps of an action until one has to wait, and counts time-outs."""

from math import inf

from openacr.mill.card.actions import Steps, Until
from openacr.mill.card.alarms import AlarmError
from openacr.mill.card.driver import CardState


class ActionPlayer:
    """Runs one action at a time."""

    def __init__(self) -> None:
        self._steps: Steps | None = None
        self._until: Until | None = None
        self._waited_s = 0.0

    @property
    def is_active(self) -> bool:
        """Whether an action is running."""
        return self._steps is not None

    @property
    def reason(self) -> str:
        """What the running action waits for; empty if nothing."""
        return self._until.reason if self._until else ""

    @property
    def is_dwelling(self) -> bool:
        """Whether the running action is a dwell of the program."""
        return self._until is not None and self._until.is_dwell

    @property
    def left_s(self) -> float:
        """Time left until the wait times out; infinite without a wait."""
        return max(self._until.limit_s - self._waited_s, 0.0) if self._until else inf

    def begin(self, steps: Steps) -> None:
        """Start an action; one that is running is cancelled."""
        try:
            self.close()
        finally:
            self._steps = steps

    def close(self) -> None:
        """Cancel the action; its `finally` clauses restore what it has changed."""
        steps, self._steps, self._until = self._steps, None, None
        self._waited_s = 0.0
        if steps is not None:
            steps.close()

    def play(self, sample: CardState, step_s: float) -> None:
        """Run the action as far as possible; `is_active` is False afterwards when it has ended."""
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
        """Drop steps that have ended, unless they have started others."""
        if self._steps is steps:
            self._steps, self._until = None, None

    def _is_over(self, until: Until, sample: CardState) -> bool:
        """Whether a wait has ended; AlarmError after its limit if it names an alarm."""
        if until.is_met(sample):
            return True
        if self._waited_s < until.limit_s:
            return False
        if until.alarm is not None:
            raise AlarmError(until.alarm, until.reason)
        return True
