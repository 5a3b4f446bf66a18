"""What a bridge reads of a machine at one time: plain data that no later reading changes."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from openacr.mill.config.tools import Tool
from openacr.panel.control.machine.snapshot import Snapshot

MM_PER_INCH = 25.4
S_PER_MIN = 60.0
Facts = Mapping[str, Mapping[str, Any]]
Axes = tuple[float, ...]


@dataclass(frozen=True, slots=True)
class AxisName:
    """An axis of the machine; a rotary one has degrees."""

    name: str
    is_rotary: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Moment:
    """One reading; lengths in units of the machine. A card without its CNC side has no `run`."""

    lost: str = ""  # why the machine cannot be read; empty while it can
    mm_per_unit: float = 1.0
    commanded: Axes = ()
    actual: Axes = ()
    following: Axes = ()
    speed_ups: float | None = None  # along the path
    is_moving: bool | None = None
    run: Snapshot | None = None
    facts: Facts = field(default_factory=dict)
    tools: tuple[Tool, ...] | None = None  # of the tool table
    bus: Mapping[str, Any] | None = None  # its report, where the card has one that is open
    watched: Mapping[int, float] = field(default_factory=dict)  # parameters of the card by number

    def fact(self, name: str, *keys: str) -> Any:
        """A fact by its name and the keys inside it; None where it is not known."""
        found: Any = self.facts.get(name)
        for key in keys:
            if not isinstance(found, Mapping):
                return None
            found = found.get(key)
        return found
