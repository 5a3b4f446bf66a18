"""The links of a machine: what each axis moves, what carries it, and where.

What `[axis.body]` leaves out follows from name and unit of the axis. An axis in degrees, radians or
revolutions turns, one called A, B or C about X, Y or Z, any other about Z. All others move along
X, Y or Z, as they are called (U, V and W: likewise). Of linear axes X, Y, Z and rotary axes
A, B, C the first of each letter is carried by the one before it in the file; all others are on the
ground, side by side.
Everything is in millimetres and degrees.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from openacr.plant.describe.body_schema import Body
from openacr.plant.describe.schema import Axis

Vector = tuple[float, float, float]

ALONG: dict[str, Vector] = {"X": (1.0, 0.0, 0.0), "Y": (0.0, 1.0, 0.0), "Z": (0.0, 0.0, 1.0)}
SPACE = {**ALONG, **dict(zip("UVW", ALONG.values(), strict=True))}
ABOUT: dict[str, Vector] = dict(zip("ABC", ALONG.values(), strict=True))
DEG_PER_UNIT = {"deg": 1.0, "degree": 1.0, "degrees": 1.0, "rad": 57.29577951308232, "rev": 360.0}
MM_PER_UNIT = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "um": 0.001, "in": 25.4, "inch": 25.4}
OPEN_MM = 100.0  # half the length that is drawn of an axis without ends
NO_BODY = Body()
SLIM, STEP = 0.06, 1.6  # of the longest travel: thickness of a rail; from link to link, in rails


@dataclass(frozen=True, slots=True)
class Subject:
    """An axis as far as it is drawn: of a machine.toml, or of a card without one."""

    number: int
    name: str
    units: str
    ends_u: tuple[float, float] | None = None
    body: Body = NO_BODY


@dataclass(frozen=True, slots=True, kw_only=True)
class Link:
    """What one axis moves."""

    axis: int
    name: str
    units: str
    is_rotary: bool
    direction: Vector  # of length 1
    parent: int | None  # place in the list of links, always before it
    origin: Vector
    per_unit: float
    low: float  # of what is drawn of the path, mm or degrees
    high: float
    has_ends: bool
    rail: float  # thickness
    size: Vector
    at: Vector
    colour: str
    file: str


def subject_of(axis: Axis) -> Subject:
    """What is drawn of an axis of a machine.toml: its ends are hard stops, else limit switches."""
    ends = axis.travel
    if ends is None and axis.negative_limit and axis.positive_limit:
        ends = (axis.negative_limit.at, axis.positive_limit.at)
    return Subject(axis.number, axis.label, axis.units, ends, axis.body)


def links_of(subjects: Iterable[Subject]) -> tuple[Link, ...]:
    """The links of axes; each one is after the link that carries it."""
    given = list(subjects)
    carriers = carriers_of(given)
    axes = _carriers_first(given, carriers)
    rail = SLIM * max(map(_length, axes), default=2 * OPEN_MM)
    places = {each.name.upper(): place for place, each in enumerate(axes)}
    found: list[Link] = []
    beside = 0
    for each in axes:
        carrier = carriers[each.name.upper()]
        parent = places[carrier] if carrier else None
        is_vertical = _direction(each) == ALONG["Z"] and not is_rotary(each)
        origin = (STEP * rail, 0.0, 0.0) if is_vertical else (0.0, 0.0, STEP * rail)
        if parent is None:
            origin = (0.0, 4.0 * rail * beside, 0.0)
            beside += 1
        found.append(_link(each, parent, origin, rail))
    return tuple(found)


def carriers_of(axes: Iterable[Subject]) -> dict[str, str]:
    """The name of the axis that carries each one, in capitals; "" for the ground."""
    found: dict[str, str] = {}
    last, seen = "", set[str]()
    for each in axes:
        name, letter = each.name.upper(), each.name[:1].upper()
        is_chained = letter in (ABOUT if is_rotary(each) else ALONG) and letter not in seen
        default = last if is_chained else ""
        found[name] = default if each.body.parent is None else each.body.parent.upper()
        if is_chained:
            seen.add(letter)
            last = name
    return found


def _carriers_first(axes: list[Subject], carriers: dict[str, str]) -> list[Subject]:
    """The axes in an order in which each one follows what carries it."""
    ordered, rest = list[Subject](), list(axes)
    placed = {""}
    while rest:
        ready = [each for each in rest if carriers[each.name.upper()] in placed]
        if not ready:
            raise ValueError(f"axis {rest[0].name} is carried by itself or by no axis")
        ordered += ready
        placed |= {each.name.upper() for each in ready}
        rest = [each for each in rest if each not in ready]
    return ordered


def is_rotary(axis: Subject) -> bool:
    """Whether an axis turns: as its table says, else by its unit, else by its name."""
    if axis.body.rotary is not None:
        return axis.body.rotary
    units = axis.units.lower()
    return units in DEG_PER_UNIT or (units not in MM_PER_UNIT and axis.name[:1].upper() in ABOUT)


def per_unit(axis: Subject) -> float:
    """Millimetres or degrees in a unit of an axis; 1 for units that are not known."""
    table = DEG_PER_UNIT if is_rotary(axis) else MM_PER_UNIT
    return axis.body.per_unit or table.get(axis.units.lower(), 1.0)


def _ends(axis: Subject) -> tuple[float, float]:
    """What is drawn of the path of an axis, mm or degrees."""
    if axis.ends_u is not None:
        low, high = axis.ends_u
        return low * per_unit(axis), high * per_unit(axis)
    return (-180.0, 180.0) if is_rotary(axis) else (-OPEN_MM, OPEN_MM)


def _length(axis: Subject) -> float:
    low, high = _ends(axis)
    return 2 * OPEN_MM if is_rotary(axis) else high - low


def _direction(axis: Subject) -> Vector:
    given = axis.body.direction
    if given is None:
        letter = axis.name[:1].upper()
        if is_rotary(axis):
            return ABOUT.get(letter, ALONG["Z"])
        return SPACE.get(letter, ALONG["X"])
    length = sum(part * part for part in given) ** 0.5
    return given[0] / length, given[1] / length, given[2] / length


def _link(axis: Subject, parent: int | None, origin: Vector, rail: float) -> Link:
    body, (low, high) = axis.body, _ends(axis)
    turns, direction = is_rotary(axis), _direction(axis)
    size: Vector = (2.2 * rail, 2.2 * rail, 2.2 * rail)
    if turns:  # an arm across the axis of rotation
        size = (
            (1.2 * rail, 5.0 * rail, rail)
            if direction == ALONG["X"]
            else (5.0 * rail, 1.2 * rail, rail)
        )
    return Link(
        axis=axis.number,
        name=axis.name,
        units=axis.units,
        is_rotary=turns,
        direction=direction,
        parent=parent,
        origin=origin if body.origin is None else body.origin,
        per_unit=per_unit(axis),
        low=low,
        high=high,
        has_ends=axis.ends_u is not None,
        rail=rail,
        size=size if body.size is None else body.size,
        at=body.at,
        colour=body.colour,
        file=body.file,
    )


def names_of(axes: Iterable[Axis]) -> Iterator[str]:
    """The names under which axes are called in tables of a machine.toml."""
    return (axis.label.upper() for axis in axes)
