"""Programs and PLCs of the card: what each of them does, for the screens that watch it."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from openacr.client import Level
from openacr.errors import UserError
from openacr.map.rows import programs as program_rows
from openacr.map.words import pf, plf
from openacr.mill.session import MillSession

PROGRAMS = range(program_rows.COUNT)
PLCS = range(len(plf.word))
# The first that holds is what a running program does.
DOES = (
    (pf.PAUSE_MODE, "paused"),
    (pf.BLOCK_MODE_WAITING, "waits for STEP"),
    (pf.PROGRAM_DWELLING, "dwells"),
    (pf.PROGRAM_INHIBITED, "inhibited"),
)
RUNS, HALTED = "running", "halted"
State = dict[str, Any]
_ROWS = [*pf.word, *program_rows.line_number, *plf.word]


def read_states(session: MillSession) -> list[State]:
    """What every program and PLC of the card does, read with one request."""
    values = list(map(int, session.machine.read_rows(_ROWS)))
    flags, values = values[: len(PROGRAMS)], values[len(PROGRAMS) :]
    lines, plc_flags = values[: len(PROGRAMS)], values[len(PROGRAMS) :]
    programs = [_program(*each) for each in zip(PROGRAMS, flags, lines, strict=True)]
    return programs + [
        {"name": str(Level.plc(n)), "state": RUNS if word & plf.PLC_RUNNING else HALTED}
        for n, word in zip(PLCS, plc_flags, strict=True)
    ]


def _program(number: int, flags: int, line: int) -> State:
    is_running = bool(flags & pf.PROGRAM_RUNNING)
    state = next((does for mask, does in DOES if flags & mask), RUNS) if is_running else HALTED
    return {
        "name": str(Level.program(number)),
        "state": state,
        "line": line if is_running else 0,
        "block": bool(flags & pf.BLOCK_CONTROL),
    }


@dataclass(slots=True)
class _Watcher:
    every_s: float
    due_s: float = 0.0
    reported: list[State] = field(default_factory=list)


class CardPrograms:
    """Who watches the programs of the card, and which of them the screens have started."""

    def __init__(self, tell: Callable[[State], None]) -> None:
        self._tell = tell
        self._watchers: dict[int, _Watcher] = {}
        self._started: set[Level] = set()

    # --- watching ---------------------------------------------------------------------

    def watch(self, client: int, hz: float) -> None:
        """Tell a client what the programs do, at once and when it has changed."""
        self._watchers[client] = _Watcher(1.0 / hz)

    def forget(self, client: int) -> None:
        """Tell a client no more; without any the card is not asked."""
        self._watchers.pop(client, None)

    def look(self, session: MillSession, now_s: float) -> None:
        """Read the states for those whose time has come, and tell what has changed."""
        due = {c: each for c, each in self._watchers.items() if now_s >= each.due_s - 0.005}
        if not due:
            return
        states = read_states(session)
        for client, each in due.items():
            each.due_s = max(each.due_s + each.every_s, now_s)
            if each.reported != states:
                each.reported = states
                self._tell({"event": "programs", "programs": states, "to": client})

    # --- commanding -------------------------------------------------------------------

    def command(self, session: MillSession, word: str, level: Level) -> None:
        """Give a program a command of the operating system: RUN, HALT, PAUSE, STEP ..."""
        session.card.go(Level())
        lines = session.card.command(f"{word} {level}")
        if lines:
            raise UserError(f"{word} {level}: {lines[-1]}")
        if word == "RUN":
            self._started.add(level)

    def stop(self, session: MillSession | None, word: str) -> None:
        """PAUSE or HALT what the screens have started, if it still runs: part of every stop."""
        if session is None or not self._started:
            return
        running = {state["name"] for state in read_states(session) if state["state"] != HALTED}
        self._started = {level for level in self._started if str(level) in running}
        for level in sorted(self._started, key=str):
            if level.word == "PROG":  # a PLC is the logic of the machine: it goes on
                self.command(session, word, level)

    def end(self) -> None:
        """The session has ended: what runs on the card now is not known."""
        self._started.clear()
