"""Programs and PLCs of the card: what each of them does, for the screens that watch it."""

from collections.abc import Callable
from typing import Any

from openacr.client import Level
from openacr.client.program_states import ROWS, ProgramState, program_states
from openacr.errors import UserError
from openacr.map.words import pf
from openacr.mill.session import MillSession
from openacr.panel.control.engineer.watchers import Watchers
from openacr.panel.control.machine.place import Rows

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


class CardPrograms:
    """Who watches the programs of the card, and the commands of their keys."""

    def __init__(self, tell: Callable[[State], None]) -> None:
        self._tell = tell
        self.watchers: Watchers[list[State]] = Watchers(self._report)

    def _report(self, client: int, states: list[State]) -> None:
        self._tell({"event": "programs", "programs": states, "to": client})

    def texts_changed(self, name: str) -> None:
        """Tell all screens that the text of a program was stored; without a name: of several."""
        self._tell({"event": "texts", "name": name})

    def command(self, session: MillSession, word: str, level: Level) -> None:
        """Give a program a command of the operating system: RUN, HALT, PAUSE, STEP ..."""
        session.card.go(Level())
        lines = session.card.command(f"{word} {level}")
        if lines:
            raise UserError(f"{word} {level}: {lines[-1]}")
