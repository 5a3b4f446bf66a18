"""The modal state: what stays in force from block to block.

One table says for each field what it is at the start of a program, at its end and after
ABORT (`acromill` reference 2.1): the rows of `RESETS`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any, Self

from msgspec import Struct

from openacr.cnc.canonical import PLANES, PathMode, Plane, Spin
from openacr.cnc.state.cells import CUT_SPEED, DEFAULT_UNIT, START_FEED, TOOL, TOOL_IN_SPINDLE
from openacr.cnc.state.hosts import Cells
from openacr.sysvar import tabs
from openacr.sysvar.tabs import CONTROL, DISPLAY, GENERAL

MODES = {
    60: PathMode.EXACT,  # without the wait for position
    61: PathMode.EXACT,
    62: PathMode.CORNER,
    63: PathMode.LOCKED,
    64: PathMode.FREE,
}
INVERSE_TIME, PER_MINUTE = 93, 94
INCH, METRIC = 20, 21
NO_CYCLE = 80
SYSTEMS = ("G53", "G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3")  # by number
START_CHOSEN = GENERAL.start_set_chosen
COMPATIBILITY = tabs.COMPATIBILITY.compatibility


@dataclass(slots=True)
class Modal:
    """All codes and numbers in force; lengths and feed in default units."""

    motion: float = 1  # G0..G3; 80: none (rs274ngc)
    plane: int = 17
    distance: int = 90
    unit: int = 20
    compensation: int = 40
    length: int = 49
    cycle: int = 80
    return_level: int = 98
    work: int = 1  # system 1..8, 0 = machine (G53)
    path: int = 64
    tolerance: float = 0.0  # G64 P
    centres: int = 2  # G200 F0, F1, F2
    feed: float = 0.0  # default units per minute
    feed_mode: int = PER_MINUTE
    speed: float = 0.0
    spin: Spin = Spin.OFF
    mist: bool = False
    flood: bool = False
    radius_number: int = 0
    length_number: int = 0
    fixture: int = 0
    tool: int = 0
    tool_in_spindle: int = 0
    tangent: int = 0  # M595, M597, M598
    is_feed_locked: bool = False  # M583
    has_feed: bool = False  # an F word was read, or a start feed chosen
    has_work: bool = False  # a G54 block was executed in this program
    memory: dict[int, float] = field(default_factory=dict)  # G28: axis to machine position

    def copy(self) -> Self:
        """Make a snapshot."""
        return replace(self, memory=dict(self.memory))

    def restore(self, other: Modal) -> None:
        """Restore the state of a snapshot."""
        for name in self.__slots__:
            setattr(self, name, getattr(other, name))

    @property
    def plane_axes(self) -> Plane:
        """The plane as axes."""
        return PLANES[self.plane]

    @property
    def work_code(self) -> str:
        """The work system as a code."""
        return SYSTEMS[self.work] if self.work < len(SYSTEMS) else SYSTEMS[1]

    @property
    def codes(self) -> list[str]:
        """The codes in force, one for each group: motion or cycle first, then the plane."""
        motion = self.cycle if self.cycle != NO_CYCLE else self.motion
        return [
            f"G{motion:g}",
            f"G{self.plane}",
            f"G{self.unit}",
            f"G{self.distance}",
            f"G{self.feed_mode}",
            f"G{self.compensation}",
            f"G{self.length}",
            self.work_code,
            f"G{self.path}",
            f"G{self.return_level}",
        ]

    def mode(self, *, is_compatible: bool) -> PathMode:
        """How moves join; with Compatibility G64 acts as G62."""
        if is_compatible and self.path == 64:
            return PathMode.CORNER
        return MODES[self.path]


Rule = Callable[[Cells], Any]


def _cell(n: int) -> Rule:
    return lambda cells: int(cells.read(n))


def _or(n: int, other: int) -> Rule:
    """A cell, or another one where it says 0."""
    return lambda cells: int(cells.read(n)) or int(cells.read(other))


def _centres(cells: Cells) -> int:
    chosen = int(cells.read(GENERAL.start_ij))
    return chosen if chosen >= 0 else int(cells.read(CONTROL.ij_inversion))


def _feed(cells: Cells) -> float:
    return cells.read(START_FEED) or cells.read(CUT_SPEED)


def store_unit(cells: Cells) -> int:
    """G20 or G21, as the unit of the machine (Default Units) is."""
    return METRIC if cells.read(DEFAULT_UNIT) else INCH


def _path(cells: Cells) -> int:
    return (
        62
        if cells.read(COMPATIBILITY) and cells.read(GENERAL.start_path_mode) == 64
        else _cell(GENERAL.start_path_mode)(cells)
    )


def always(value: object) -> Rule:
    """The same on every machine."""
    return lambda cells: value


class Reset(Struct, frozen=True):
    """The values of a field at power-up, at the start and end of programs, at ABORT."""

    field: str
    power_up: Rule
    chosen: Rule | None = None  # of the start set; without: as at power-up
    at_abort: bool = True


RESETS = (
    Reset("motion", always(1), _cell(GENERAL.start_motion)),
    Reset("plane", always(17), _cell(GENERAL.start_plane)),
    Reset(
        "distance",
        _cell(CONTROL.power_up_incremental_or_absolute),
        _or(GENERAL.start_distance, CONTROL.power_up_incremental_or_absolute),
    ),
    Reset("unit", _cell(DISPLAY.control_mode), _or(GENERAL.start_unit, DISPLAY.control_mode)),
    Reset("compensation", always(40)),
    Reset("length", always(49)),
    Reset("length_number", always(0)),
    Reset("fixture", always(0)),
    Reset("cycle", always(80)),
    Reset("return_level", always(98), _cell(GENERAL.start_return_level)),
    Reset(
        "work",
        always(1),
        lambda cells: max(0, int(cells.read(GENERAL.start_work_system)) - 53),
        at_abort=False,
    ),
    Reset("path", lambda cells: 62 if cells.read(COMPATIBILITY) else 64, _path),
    Reset("tolerance", always(0.0)),
    Reset("centres", _cell(CONTROL.ij_inversion), _centres),
    Reset("feed", _feed, _feed),
    Reset("feed_mode", always(PER_MINUTE)),
    Reset("has_feed", lambda cells: cells.read(START_FEED) > 0.0),
    Reset("spin", always(Spin.OFF)),
    Reset("mist", always(False)),
    Reset("flood", always(False)),
    Reset("tool", _cell(TOOL)),
    Reset("tool_in_spindle", _cell(TOOL_IN_SPINDLE)),
    Reset("radius_number", always(0)),
    Reset("tangent", always(0)),
    Reset("is_feed_locked", always(False)),
    Reset("has_work", always(False)),
    Reset("memory", lambda cells: {}),
)


def reset(modal: Modal, cells: Cells, *, is_abort: bool = False) -> None:
    """Reset the fields for a program start, its end or ABORT."""
    is_chosen = cells.read(START_CHOSEN) != 0.0
    for row in RESETS:
        if row.at_abort or not is_abort:
            rule = row.chosen if is_chosen and row.chosen else row.power_up
            setattr(modal, row.field, rule(cells))
