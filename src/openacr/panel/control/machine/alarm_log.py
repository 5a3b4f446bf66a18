"""Which alarms were active, and had been, on each branch of the history of a card."""

from typing import Any, NamedTuple

from openacr.panel.control.machine.branch_notes import BranchNotes

MOST = 2000  # changes of a branch
Data = dict[str, Any]


class Alarmed(NamedTuple):
    """The alarms from a tick on, as the screens get them: those that are active, all so far."""

    tick: int
    active: list[Data]
    history: list[Data]


class AlarmLog(BranchNotes[Alarmed]):
    """The alarms of all branches, noted at the polls of the panel where they are others."""

    def __init__(self) -> None:
        super().__init__(MOST)

    def shown(self, branch: int, tick: int) -> Data:
        """The alarms at a tick, as the screens get them; none before the first that is known."""
        found = self.at(branch, tick) or Alarmed(tick, [], [])
        return {"active": found.active, "history": found.history}
