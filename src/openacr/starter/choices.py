"""What can be chosen for a first project, and what is chosen where nothing is said."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

from openacr.errors import UserError
from openacr.models import DEFAULT_MODEL
from openacr.motion.axis.attach import RESERVED_NAMES

MODEL = DEFAULT_MODEL
INPUTS_PER_AXIS = 3  # positive limit, negative limit, home
AXIS_NAME = re.compile(r"[A-Z]{1,4}")
INPUT_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]{0,30}")
SHORTEST_REV, LONGEST_REV = 4.0, 2000.0  # of travel, in revolutions of a motor


class Kind(StrEnum):
    """The work that the program of a new machine does."""

    AXIS = "axis"
    GANTRY = "gantry"
    MILL = "mill"
    TURNTABLE = "turntable"


class Unit(StrEnum):
    """The unit of all positions."""

    MM = "mm"
    INCH = "in"
    DEGREE = "deg"
    REVOLUTION = "rev"


class Limits(StrEnum):
    """What ends the travel of an axis before its hard stops."""

    NONE = "none"
    SWITCHES = "switches"
    SOFT = "soft"
    BOTH = "both"


class Homing(StrEnum):
    """How an axis finds its zero."""

    NONE = "none"
    SWITCH = "switch"
    MARKER = "marker"


@dataclass(frozen=True, slots=True)
class KindRow:
    """One kind of machine: its title and what is chosen where nothing is said."""

    title: str
    axes: tuple[str, ...]
    unit: Unit
    limits: Limits
    homing: Homing
    fewest_axes: int = 1
    has_tool_axis: bool = False  # the last of three axes or more: zero at the top, works downwards
    tool: str = ""  # what output 32 switches
    work: str = ""  # what a cycle does


KINDS = {
    Kind.AXIS: KindRow(
        "Single axis", ("X",), Unit.MM, Limits.BOTH, Homing.SWITCH,
        work="goes out and back",
    ),
    Kind.GANTRY: KindRow(
        "Gantry", ("X", "Y", "Z"), Unit.MM, Limits.BOTH, Homing.MARKER, 2,
        has_tool_axis=True, tool="gripper", work="carries parts from one place to another",
    ),
    Kind.MILL: KindRow(
        "Mill", ("X", "Y", "Z"), Unit.MM, Limits.BOTH, Homing.MARKER, 2,
        has_tool_axis=True, tool="spindle", work="cuts the contour of a part",
    ),
    Kind.TURNTABLE: KindRow(
        "Turntable", ("A",), Unit.DEGREE, Limits.NONE, Homing.SWITCH, tool="clamp",
        work="indexes through six stations",
    ),
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class UnitRow:
    """One unit: how much of it is a revolution of the motor, and the travel of an axis."""

    title: str
    per_rev_u: float
    travel_u: float


UNITS = {
    Unit.MM: UnitRow("millimetres", 5.0, 200.0),
    Unit.INCH: UnitRow("inches", 0.2, 8.0),
    Unit.DEGREE: UnitRow("degrees", 36.0, 360.0),
    Unit.REVOLUTION: UnitRow("revolutions", 1.0, 40.0),
}


@dataclass(frozen=True, slots=True)
class Choices:
    """Everything that is chosen for a project; `choices` makes it, checked."""

    kind: Kind
    axes: tuple[str, ...]
    unit: Unit
    travel_u: float
    limits: Limits
    homing: Homing
    inputs: tuple[str, ...]
    has_plc: bool

    @property
    def row(self) -> KindRow:
        """The facts of the kind."""
        return KINDS[self.kind]

    @property
    def first_free_input(self) -> int:
        """The first input after those of the axes a card has."""
        return INPUTS_PER_AXIS * MODEL.axes


def choices(
    kind: Kind,
    *,
    axes: Sequence[str] = (),
    unit: Unit | None = None,
    travel_u: float | None = None,
    limits: Limits | None = None,
    homing: Homing | None = None,
    inputs: Sequence[str] = (),
    has_plc: bool = False,
) -> Choices:
    """Complete and check choices; UserError names the option that is wrong.

    `travel_u` is in units and the same for all axes. The first of `inputs` is the button that
    starts a cycle, the others are conditions that have to be on for it.
    """
    row = KINDS[kind]
    unit = unit or row.unit
    return Choices(
        kind,
        _axes(kind, axes or row.axes),
        unit,
        _travel(unit, UNITS[unit].travel_u if travel_u is None else travel_u),
        limits or row.limits,
        homing or row.homing,
        _inputs(inputs),
        has_plc,
    )


def _axes(kind: Kind, axes: Sequence[str]) -> tuple[str, ...]:
    names = tuple(name.strip().upper() for name in axes)
    for name in names:
        if not AXIS_NAME.fullmatch(name) or name in RESERVED_NAMES:
            raise UserError(
                f"--axes: {name!r} is no name of an axis: one to four letters, and none of "
                + ", ".join(sorted(RESERVED_NAMES))
            )
        if names.count(name) > 1:
            raise UserError(f"--axes: {name} is there twice")
    fewest = KINDS[kind].fewest_axes
    if not fewest <= len(names) <= MODEL.axes:
        raise UserError(
            f"--axes: {len(names)} given; the kind {kind} has {fewest} to {MODEL.axes} of them"
        )
    return names


def _travel(unit: Unit, travel_u: float) -> float:
    turn = UNITS[unit].per_rev_u
    low, high = SHORTEST_REV * turn, LONGEST_REV * turn
    if not low <= travel_u <= high:
        raise UserError(f"--travel: {travel_u:g} {unit}; give {low:g} to {high:g} {unit}")
    return travel_u


def _inputs(inputs: Sequence[str]) -> tuple[str, ...]:
    names = tuple(name.strip() for name in inputs)
    free = MODEL.lines - INPUTS_PER_AXIS * MODEL.axes
    if len(names) > free:
        raise UserError(f"--inputs: {len(names)} given; {free} inputs are free")
    for name in names:
        if not INPUT_NAME.fullmatch(name):
            raise UserError(
                f"--inputs: {name!r} is no name of an input: a letter, then letters, digits, - or _"
            )
        if names.count(name) > 1:
            raise UserError(f"--inputs: {name} is there twice")
    return names
