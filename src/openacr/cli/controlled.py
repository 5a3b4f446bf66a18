"""The machine of a run: a `Controller` with its project loaded."""

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from openacr.controller import Controller


def load(project: Path) -> "ControlledMachine":
    """Load a project folder or file into a new card."""
    from openacr.controller import Controller

    return ControlledMachine(Controller.from_project(project))


class ControlledMachine:
    """A controller, seen as what a run needs."""

    def __init__(self, controller: "Controller") -> None:
        self._controller = controller
