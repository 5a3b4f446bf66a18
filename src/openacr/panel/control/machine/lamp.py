"""What the card does by command of any host: for the lamp at the top of every screen."""

from typing import Any

from openacr.client.program_states import PROGRAMS
from openacr.map.rows import axes
from openacr.map.words import af4, pf
from openacr.mill.config.settings import Settings
from openacr.panel.control.machine.link import Link

EVERY_S = 0.25
AXES = range(len(axes.primary_setpoint))
ROWS = [*pf.word, *af4.word, *axes.primary_setpoint]
NOTHING: dict[str, list[str]] = {"moving": [], "running": [], "drives": []}


class Lamp:
    """The card as it was read last; an axis moves while its setpoint changes."""

    def __init__(self, link: Link) -> None:
        self._link = link
        self._due_s = 0.0
        self._before: list[float] = []
        self._data: dict[str, Any] = NOTHING

    def look(self, now_s: float) -> None:
        """Read the card where it is time; a link error where it does not answer."""
        if now_s < self._due_s:
            return
        self._due_s = now_s + EVERY_S
        values = self._link.read(ROWS)
        session = self._link.session
        settings = Settings(self._link.installation.store)
        name = self._link.installation.axis_name
        is_watched = session is None or session.is_set_up  # by a program of AcroMill
        count = len(PROGRAMS)
        programs, drives = values[:count], values[count : count + len(AXES)]
        setpoints = values[count + len(AXES) :]
        changed = zip(self._before or setpoints, setpoints, strict=True)
        self._before = setpoints
        self._data = {
            "moving": [name(n) for n, (a, b) in enumerate(changed) if a != b],
            "running": [
                f"PROG{n}"
                for n, word in enumerate(programs)
                if int(word) & pf.PROGRAM_RUNNING
                and not (is_watched and n == settings.watchdog_program)
            ],
            "drives": [name(n) for n, word in enumerate(drives) if int(word) & af4.DRIVE_ENABLED],
        }

    def end(self) -> None:
        """The session has ended: what the card does is not known."""
        self._before, self._data = [], NOTHING

    def data(self) -> dict[str, Any]:
        """Axes that move, programs that run, axes whose drives are on."""
        return self._data
