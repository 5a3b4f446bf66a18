"""The block of a part program that is executed now."""

from collections.abc import Callable

from openacr.cnc.canonical import Source
from openacr.mill.run.lifecycle import State
from openacr.panel.control.shared import Shared

UNDER_WAY = frozenset({State.RUN, State.WAIT, State.PAUSED, State.HOLD})


class Executing:
    """The block that a part program is at; empty while none runs. Neither MDI nor homing is one."""

    def __init__(self, station: Shared) -> None:
        self._station = station
        self.file = ""
        self.line = 0  # of that file
        self.caller: Source | None = None  # the block whose cycle it belongs to
        self.text = ""

    @property
    def is_under_way(self) -> bool:
        """Whether a part program runs, waits or is held."""
        session = self._station.session
        if session is None or session.runner.options.is_mdi:
            return False
        return session.runner.state in UNDER_WAY

    def follow(self, text_of: Callable[[Source], str]) -> None:
        """Note the executing block, and its text when it is another one than before."""
        session = self._station.session
        source = session.runner.source if session is not None and self.is_under_way else None
        found = (source.file, source.line, source.caller) if source is not None else ("", 0, None)
        if found == (self.file, self.line, self.caller):
            return
        self.file, self.line, self.caller = found
        self.text = "" if source is None else (source.text or text_of(source)).strip()
