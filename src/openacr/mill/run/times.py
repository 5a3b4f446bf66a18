"""Card time as a run counts it: since its start, since the last look, since something was due."""


class Times:
    """Clocks of one run; all of them follow the clock of the card."""

    def __init__(self) -> None:
        self.step_s = 0.0  # between the last two looks
        self._now_s = self._start_s = 0.0
        self._due: dict[str, float] = {}

    def restart(self) -> None:
        """A run begins now."""
        self._start_s = self._now_s

    def advance_to(self, now_s: float) -> None:
        """The card was looked at."""
        self.step_s, self._now_s = now_s - self._now_s, now_s

    @property
    def run_s(self) -> float:
        """Since the run began."""
        return self._now_s - self._start_s

    def is_due(self, what: str, every_s: float) -> bool:
        """True once in `every_s` seconds for each name, the first time at once."""
        if self._now_s < self._due.get(what, self._now_s):
            return False
        self._due[what] = self._now_s + every_s
        return True
