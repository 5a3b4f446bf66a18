"""Programs and PLCs of the card: what each of them does, for the screens that watch it."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from openacr.client import Level
from openacr.client.program_states import ROWS, ProgramState, program_states
from openacr.errors import UserError
from openacr.map.words import pf
from openacr.mill.session import MillSession
from openacr.panel.control.place import Rows

State = dict[str, Any]


def read_states(read: Rows) -> list[State]:
    """What every program and PLC of the card does, read with one request."""
    return list(map(_shown, program_states(read(list(ROWS)))))


def _shown(state: ProgramState) -> State:
    shown: State = {"name": str(state.level), "state": state.does}
    if state.level.word == "PLC":
        return shown
    return shown | {
        "line": state.line if state.is_running else 0,
        "block": bool(state.flags & pf.BLOCK_CONTROL),
    }


@dataclass(slots=True)
class _Watcher:
    every_s: float
    due_s: float = 0.0
    reported: list[State] = field(default_factory=list)


class CardPrograms:
    """Who watches the programs of the card, and the commands of their keys."""

    def __init__(self, tell: Callable[[State], None]) -> None:
        self._tell = tell
        self._watchers: dict[int, _Watcher] = {}

    # --- watching ---------------------------------------------------------------------

    def watch(self, client: int, hz: float) -> None:
        """Tell a client what the programs do, at once and when it has changed."""
        self._watchers[client] = _Watcher(1.0 / hz)

    def forget(self, client: int) -> None:
        """Tell a client no more; without any the card is not asked."""
        self._watchers.pop(client, None)

    def look(self, read: Rows, now_s: float) -> None:
        """Read the states for those whose time has come, and tell what has changed."""
        due = {c: each for c, each in self._watchers.items() if now_s >= each.due_s - 0.005}
        if not due:
            return
        states = read_states(read)
        for client, each in due.items():
            each.due_s = max(each.due_s + each.every_s, now_s)
            if each.reported != states:
                each.reported = states
                self._tell({"event": "programs", "programs": states, "to": client})

    def texts_changed(self, name: str) -> None:
        """Tell all screens that the text of a program was stored; without a name: of several."""
        self._tell({"event": "texts", "name": name})

    # --- commanding -------------------------------------------------------------------

    def command(self, session: MillSession, word: str, level: Level) -> None:
        """Give a program a command of the operating system: RUN, HALT, PAUSE, STEP ..."""
        session.card.go(Level())
        lines = session.card.command(f"{word} {level}")
        if lines:
            raise UserError(f"{word} {level}: {lines[-1]}")
