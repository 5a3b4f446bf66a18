"""The cards of a test run: one for each module and project, as new for every test."""

from __future__ import annotations

from pathlib import Path

from openacr.controller import Controller
from openacr.controller.snapshot import Snapshot
from openacr.testing.coverage import Coverage
from openacr.testing.machine import Machine


class Bench:
    """Loads a project once for each module; a snapshot gives every test the same card."""

    def __init__(self, *, covers: bool = False) -> None:
        self.coverage = Coverage() if covers else None
        self._module = ""
        self._loaded: dict[Path | None, tuple[Controller, Snapshot]] = {}

    def machine(self, module: str, project: Path | None) -> Machine:
        """The card of a project, as it was after loading."""
        if module != self._module:
            self._close()
            self._module = module
        if project not in self._loaded:
            card = Controller() if project is None else Controller.from_project(project)
            self._loaded[project] = card, card.snapshot()
        card, snapshot = self._loaded[project]
        if self.coverage is not None:
            self.coverage.prepare(card)
        card.take_over(snapshot)
        machine = Machine(card, project)
        machine.begin()
        if self.coverage is not None:
            self.coverage.begin(card)
        return machine

    def finish(self, machine: Machine) -> None:
        """A test is over: nothing of it hears the card any more."""
        machine.card.watch()
        machine.card.system.listeners.taps.clear()
        if self.coverage is not None:
            self.coverage.end(machine.card)

    def _close(self) -> None:
        for card, _ in self._loaded.values():
            card.close()
        self._loaded.clear()
