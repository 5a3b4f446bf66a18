"""Clocks of a run in card time: since its start, since the last poll, and periods."""


class Times:
    """Clocks of one run, advanced by the clock of the card."""

    def __init__(self) -> None:
        self.step_s = 0.0  # between the last two polls
        self.run_s = 0.0  # of the present run, or of the last one; 0 before the first
        self.pass_s = 0.0  # of the present pass, as its prediction counts it
        self._now_s = self._start_s = 0.0
        self._due: dict[str, float] = {}

    def restart(self) -> None:
        """Start the clock of a run."""
        self._start_s, self.run_s = self._now_s, 0.0

    def begin_pass(self) -> None:
        """Start the clock of a pass of the program."""
        self.pass_s = 0.0

    def advance_to(self, now_s: float, *, is_running: bool, rate: float) -> None:
        """Advance to the card time of a poll; the time of a run ends with it.

        `rate` is the predicted time that passes per second.
        """
        self.step_s, self._now_s = now_s - self._now_s, now_s
        if is_running:
            self.run_s = now_s - self._start_s
            self.pass_s += rate * self.step_s

    def is_due(self, what: str, every_s: float) -> bool:
        """True once in `every_s` seconds for each name, the first time at once."""
        if self._now_s < self._due.get(what, self._now_s):
            return False
        self._due[what] = self._now_s + every_s
        return True
