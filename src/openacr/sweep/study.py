"""A sweep that was read and checked: all that a worker process needs for a run of it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from hashlib import blake2b
from pathlib import Path

from openacr.project import Project
from openacr.scenario.course import Until
from openacr.scenario.schema import Scenario
from openacr.sweep.expressions import Measure, Needs
from openacr.sweep.schema import Design, Optimise, Quantity

Point = tuple[float, ...]  # a value for each quantity, in their order


@dataclass(frozen=True)
class Study:
    """A sweep: files, quantities, measures. It is sent to workers, which need no file of it."""

    project: Project
    machine: str | None  # text of machine.toml
    devices: tuple[bytes, ...]  # the Python files beside it, which devices are read from
    scenario: Scenario | None
    scenario_text: str
    limit_s: float
    until: Until | None
    every_tk: int
    quantities: dict[str, Quantity]
    measures: dict[str, str]
    design: Design
    optimise: Optimise | None

    @property
    def machine_path(self) -> str:
        """The machine file as the user named it."""
        return str(self.project.machine or Path("machine.toml"))

    @cached_property
    def fingerprint(self) -> str:
        """What decides the results of a point: files, targets, the end of a run, measures."""
        targets = {
            name: (each.machine, each.parameter, each.define, each.line)
            for name, each in self.quantities.items()
        }
        files = [(str(each.place), each.number, each.data) for each in self.project.sources]
        decides = (
            files, self.machine, self.devices, self.scenario_text, self.limit_s,
            str(self.until), self.every_tk, targets, self.measures,
        )  # fmt: skip
        return blake2b(repr(decides).encode(), digest_size=16).hexdigest()

    @cached_property
    def needs(self) -> Needs:
        """What is to be recorded for the measures."""
        return self._checked[0]

    @cached_property
    def expressions(self) -> dict[str, Measure]:
        """The measures, ready to be evaluated."""
        return self._checked[1]

    @cached_property
    def _checked(self) -> tuple[Needs, dict[str, Measure]]:
        needs, found = Needs(), dict[str, Measure]()
        for name, text in self.measures.items():
            found[name] = Measure(text, frozenset((*self.quantities, *found)), needs)
        return needs, found
