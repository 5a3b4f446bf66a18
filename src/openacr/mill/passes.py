"""Passes of a program: once, or over and over where the store says so."""

from openacr.errors import UserError
from openacr.mill.console import Console
from openacr.mill.course import Course, Entries
from openacr.mill.ending import Ending
from openacr.mill.panel import Panel
from openacr.mill.states import Status


class Passes:
    """The passes of what runs on one machine."""

    def __init__(
        self, panel: Panel, course: Course, console: Console, ending: Ending, status: Status
    ) -> None:
        self.count = 0  # ends of programs reached
        self._panel = panel
        self._course = course
        self._console = console
        self._ending = ending
        self._status = status
        self._entries: Entries | None = None

    def load(self, entries: Entries) -> None:
        """Begin the first pass of a program."""
        self._entries = entries
        self._begin()

    def finish(self) -> None:
        """M2 or the end: over, or once more."""
        options = self._status.options
        if not options.is_mdi:
            self.count += 1
            self._console.count_part(self.count)
        if self._panel.settings.repeats and options.is_repeated:
            self._begin()
        else:
            self._ending.finish()

    def _begin(self) -> None:
        """The program from its first block on."""
        if self._entries is None:
            raise UserError("no program is loaded")
        options = self._status.options
        self._course.begin(self._entries, is_dry=options.is_dry, is_single=options.is_single)
