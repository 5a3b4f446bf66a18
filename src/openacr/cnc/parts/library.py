"""Library parts: part programs with sizes to choose.

Before a part runs, its sizes are set in their cells, lengths in the active unit; P224 is
then the radius of the tool and P233 the lead-in radius of the store.
"""

from collections.abc import Iterator, Mapping
from pathlib import Path

from msgspec import Struct

from openacr.cnc.parts.part import (
    INCH,
    LEAD_IN,
    MM,
    TOOL_RADIUS,
    Part,
    PartError,
    Rule,
    head_lines,
    read_part,
    text_of,
)
from openacr.cnc.reading.findings import CodeError, Finding
from openacr.cnc.state.cells import (
    CMP_RAD,
    CUT_SPEED,
    DEFAULT_UNIT,
    LAST_RADIUS,
    LIBRARY_CENTRES,
    RADII,
    RADIUS_WEARS,
    START_FEED,
)
from openacr.cnc.state.hosts import Cells
from openacr.errors import UserError
from openacr.sysvar.tabs import CONTROL, DISPLAY, GENERAL
from openacr.units import MM_PER_INCH

FOLDER = Path(__file__).parent / "library"
SUFFIX = ".TXT"
LENGTHS = frozenset((INCH, MM))
DIGITS = 12
G21 = 21


class Ready(Struct, frozen=True):
    """A part with its sizes: the cells to set before it starts, and its text."""

    part: Part
    values: Mapping[int, float]  # cells, lengths in the active unit
    ij_code: int  # reading of I and J (G200 F) until the part has a G200
    is_metric: bool
    feed: float  # active units per minute
    d_number: int  # 0: the radius is that of CMP RAD

    @property
    def program(self) -> str:
        """The part and its sizes as one part program."""
        lines = [f"; {self.part.name}", "G21" if self.is_metric else "G20"]
        lines += [f"G200 F{self.ij_code}", f"F{_plain(self.feed)}"]
        if self.d_number:
            lines.append(f"D{self.d_number}")
        names = {TOOL_RADIUS: "radius of the tool", LEAD_IN: "radius of the lead-in"}
        names |= {size.cell: size.text for size in self.part.sizes}
        for cell, value in self.values.items():
            lines.append(f"P{cell}={_plain(value)} ; {names[cell]}")
        return "\n".join(lines) + "\n" + self.part.text


def _plain(value: float) -> str:
    """A number without exponent."""
    return f"{value:.{DIGITS}f}".rstrip("0").rstrip(".")


# --- reading ----------------------------------------------------------------------------


def names(folder: Path = FOLDER) -> list[str]:
    """The parts in a folder; other texts there have no PART line."""
    return sorted(path.stem.upper() for path in _files(folder) if _is_part(path))


def _files(folder: Path) -> list[Path]:
    try:
        return [path for path in folder.iterdir() if path.suffix.upper() == SUFFIX]
    except OSError as error:
        raise UserError(f"{folder}: cannot be read: {error.strerror}") from None


def _is_part(path: Path) -> bool:
    return any(kind == "PART" for kind, _, _ in head_lines(text_of(path)))


def part_named(name: str, folder: Path = FOLDER) -> Part:
    """The part with a name, ignoring case."""
    wanted = name.strip().upper().removesuffix(SUFFIX)
    for path in _files(folder):
        if path.stem.upper() == wanted and _is_part(path):
            return read_part(path)
    raise UserError(f"there is no part {name} (there are {', '.join(names(folder))})")


# --- preparing --------------------------------------------------------------------------


def begins_metric(cells: Cells) -> bool:
    """Whether programs begin in millimetres, as the start set and the DISPLAY tab say."""
    chosen = cells.read(GENERAL.start_unit) if cells.read(GENERAL.start_set_chosen) else 0
    return (chosen or cells.read(DISPLAY.control_mode)) == G21


def prepared(
    part: Part,
    given: Mapping[int, float],
    cells: Cells,
    *,
    is_metric: bool,
    d_number: int = 0,
    feed: float | None = None,
) -> Ready:
    """Prepare a part with these sizes (in their own units), and defaults for the others.

    `is_metric` is the active unit; without `feed` (in it) the one of the run set-up holds, or
    Cut Speed. PartError with code E222 if a size is out of range or a condition does not hold.
    """
    store_unit = MM if cells.read(DEFAULT_UNIT) else INCH
    active = MM if is_metric else INCH
    values: dict[int, float] = {}
    findings: list[Finding] = []
    for size in part.sizes:
        value = given.get(size.cell, size.default)
        if not size.low <= value <= size.high:
            detail = f"{size} = {value:g} ({size.accepted})"
            findings.append(CodeError("E222", detail=detail).at(str(part.path), size.line, ""))
        values[size.cell] = in_unit(value, size.unit, active)
    radius = in_unit(tool_radius(cells, d_number), store_unit, active)
    values.setdefault(TOOL_RADIUS, radius)  # a part may use that cell for a size of its own
    values[LEAD_IN] = in_unit(cells.read(CONTROL.default_lead_in_radius), store_unit, active)
    if not findings:
        findings = [
            finding for rule in part.rules for finding in _broken(part, rule, values, cells)
        ]
    if findings:
        raise PartError(findings)
    if feed is None:
        feed = in_unit(cells.read(START_FEED) or cells.read(CUT_SPEED), store_unit, active)
    if not feed > 0.0:
        raise UserError(f"feed {feed:g}: it must be above 0")
    return Ready(part, values, int(cells.read(LIBRARY_CENTRES)), is_metric, feed, d_number)


def in_unit(value: float, unit: str, active: str) -> float:
    """A length in the active unit; anything else as it is."""
    if unit == active or unit not in LENGTHS:
        return value
    converted = value * MM_PER_INCH if active == MM else value / MM_PER_INCH
    return float(f"{converted:.{DIGITS}g}")


def tool_radius(cells: Cells, d_number: int) -> float:
    """The radius of a D number with its wear, in default units; that of CMP RAD for 0."""
    if not d_number:
        return abs(cells.read(CMP_RAD))
    if not 1 <= d_number <= LAST_RADIUS:
        raise UserError(f"D{d_number}: offsets are D1 to D{LAST_RADIUS}")
    return abs(cells.read(RADII + d_number) + cells.read(RADIUS_WEARS + d_number))


def _broken(part: Part, rule: Rule, values: Mapping[int, float], cells: Cells) -> Iterator[Finding]:
    """The finding of a condition that does not hold."""
    try:
        if rule.condition.value(_Sizes(values, cells)):
            return
        fault = CodeError("E222", detail=f"{rule.text} does not hold")
    except CodeError as found:
        fault = found
    except (ArithmeticError, ValueError):
        fault = CodeError("E210", detail=rule.text)
    yield fault.at(str(part.path), rule.line, "")


class _Sizes:
    """The operands of conditions: sizes and cells of the store."""

    def __init__(self, values: Mapping[int, float], cells: Cells) -> None:
        self._values, self._cells = values, cells

    def read_p(self, n: float) -> float:
        """A size, or a cell of the store."""
        if n in self._values:
            return self._values[int(n)]
        home = self._cells.home(int(n))
        if n != int(n) or home.is_on_card or home.read_error:
            raise CodeError("E211", detail=f"P{n:g}")
        return self._cells.read(int(n))

    def read_hash(self, n: float) -> float:
        """The same."""
        return self.read_p(n)

    def read_named(self, name: str) -> float:
        """A CodeError: a CHECK has no named parameters."""
        raise CodeError("E108", hint="a CHECK knows parameters alone")

    def has_named(self, name: str) -> bool:
        """Always False: a CHECK has no named parameters."""
        return False

    def read_input(self, n: float) -> float:
        """Refuse inputs: conditions may use parameters only."""
        raise CodeError("E108", hint="a CHECK knows parameters alone")

    read_output = read_bit = read_input
