"""Ballscrew compensation tables: in files, computed from measurements, and on the card.

An entry is the primary setpoint minus the mean of what was measured there: what has to be
added to the setpoint so that the axis arrives. Positions count from the reference point and
are never negative in a file: entries below the reference point follow at the end, as if
the screw closed on itself (`wrapped`). Between entries the card interpolates linearly.
"""

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from statistics import fmean

from openacr.client import Card
from openacr.client.values import number_text
from openacr.errors import UserError
from openacr.mill.config.settings import Settings, Store
from openacr.mill.config.tabs import AxisSettings
from openacr.sysvar.tabs import HOME, OFFSETS
from openacr.wording import counted

NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)"
LINE = re.compile(rf"\s*([A-Za-z])\s*({NUMBER})\s*[Ee]\s*({NUMBER})\s*")
MINUS_SIGNS = str.maketrans("\u2212\u2013", "--")  # of printed tables
LEAST_ENTRIES, MOST_SEGMENTS = 2, 64
MOST_BYTES = 1_000_000
SAME_U, SAME_CNT = 1e-6, 1e-3
DECIMALS = 5
LEAST_COLUMNS = 4  # position, a measurement, its mean and the difference
ROUNDED_U = 5.01e-4  # of results with three digits

Entries = tuple[tuple[float, float], ...]


@dataclass(frozen=True, slots=True)
class Table:
    """Positions from the reference point in ascending order, each with its error."""

    letter: str
    entries: Entries

    @property
    def period_u(self) -> float:
        """The distance after which a wrapped table repeats."""
        (first, _), (second, _), (last, _) = self.entries[0], self.entries[1], self.entries[-1]
        return last - first + (second - first)

    def text(self) -> str:
        """The table as a file."""
        lines = (f"{self.letter}{_short(p, 6)}E{_fixed(error)}" for p, error in self.entries)
        return "\n".join([*lines, ""])

    def along(self, limits: tuple[float, float] | None) -> Entries:
        """The entries at positions of the axis, some of them negative.

        `limits` are the soft limits, the positive one first: entries beyond it belong below
        the reference point. Without limits that is unknown, and the table is laid out twice.
        """
        if self.entries[0][0] < 0.0:
            return self.entries
        back = [(p - self.period_u, error) for p, error in self.entries]
        if limits is None:
            return (*back, *self.entries)
        high = limits[0] + SAME_U
        below = [low for low, (p, _) in zip(back, self.entries, strict=True) if p > high]
        return (*below, *(entry for entry in self.entries if entry[0] <= high))


def _short(value: float, decimals: int) -> str:
    return f"{value:.{decimals}f}".rstrip("0").rstrip(".")


def _fixed(error: float) -> str:
    """An error as the files write it: five digits after the point, no zero before it."""
    text = f"{error:.{DECIMALS}f}"
    if abs(float(text) - error) > SAME_U / 10.0:
        text = _short(error, 9)
    return text.replace("0.", ".", 1) if text.lstrip("-").startswith("0.") else text


# --- files ------------------------------------------------------------------------------


def read(path: Path, letter: str) -> Table:
    """Read the table of an axis from a file."""
    return parse(_content(path), letter, str(path))


def _content(path: Path) -> str:
    try:
        if path.stat().st_size > MOST_BYTES:
            raise UserError(f"{path}: larger than {MOST_BYTES} bytes: not a table of an axis")
        return path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise UserError(f"{path}: cannot be read: {(error.strerror or '').lower()}") from None
    except UnicodeDecodeError:
        raise UserError(f"{path}: it is not text") from None


def parse(text: str, letter: str, name: str = "table") -> Table:
    """Parse the table of an axis; UserError names the first wrong line."""
    entries: list[tuple[float, float]] = []
    for number, line in enumerate(text.translate(MINUS_SIGNS).splitlines(), 1):
        if not line.strip():
            continue
        found = LINE.fullmatch(line)
        where = f"{name}:{number}"
        if found is None:
            raise UserError(f"{where}: {line.strip()[:40]!r} is not like {letter}1E.00175")
        if found[1].upper() != letter.upper():
            raise UserError(f"{where}: axis {found[1].upper()}, but the table is that of {letter}")
        position = float(found[2])
        if any(abs(position - other) < SAME_U for other, _ in entries):
            raise UserError(f"{where}: position {position:g} occurs twice")
        entries.append((position, float(found[3])))
    if len(entries) < LEAST_ENTRIES:
        raise UserError(f"{name}: {counted(len(entries), 'entry')}; a table needs {LEAST_ENTRIES}")
    return Table(letter, tuple(sorted(entries)))


# --- measurements -----------------------------------------------------------------------


def measured(path: Path, letter: str, home_u: float) -> Table:
    """Compute a table from a file of measurements; `computed` says what its lines are."""
    return computed(_content(path), letter, home_u, str(path))


def computed(text: str, letter: str, home_u: float, name: str = "measurements") -> Table:
    """Compute a table from measurements: lines of a position and its measured values.

    Numbers are separated by commas, semicolons, tabs or blanks; lines that begin with # and
    a heading are skipped. A position may have several measurements, in one line or in separate
    lines, followed by their mean and the difference, as the guide prints them
    (Appendix A). Positions are physical, `home_u` is the reference point.
    """
    rows: dict[float, list[float]] = {}
    for place, values in _measurements(text, name):
        if len(values) < LEAST_ENTRIES:
            raise UserError(f"{place}: a position and at least one measurement are needed")
        rows.setdefault(values[0], []).extend(values[1:])
    if len(rows) < LEAST_ENTRIES:
        raise UserError(f"{name}: {counted(len(rows), 'position')}; a table needs {LEAST_ENTRIES}")
    if not min(rows) <= home_u <= max(rows):
        raise UserError(f"{name}: home {home_u:g} is not between {min(rows):g} and {max(rows):g}")
    return wrapped(letter, {n: errors(n, values) for n, values in rows.items()}, home_u)


def _measurements(text: str, name: str) -> list[tuple[str, list[float]]]:
    """Location of each line in the text, and its position with the measurements."""
    found: list[tuple[str, list[float]]] = []
    has_results = False
    for number, line in enumerate(text.translate(MINUS_SIGNS).splitlines(), 1):
        words = re.split(r"[,;\s]+", line.strip().strip(",;"))
        if not words[0] or words[0].startswith("#"):
            continue
        values = _numbers(words)
        if values is not None:
            found.append((f"{name}:{number}", values))
        elif found:
            raise UserError(f"{name}:{number}: a position and at least one measurement are needed")
        else:
            has_results |= "mean" in line.lower() or "difference" in line.lower()
    if has_results or (found and all(_has_results(values) for _, values in found)):
        return [(place, _without_results(place, values)) for place, values in found]
    return found


def _has_results(values: list[float]) -> bool:
    """Whether a line ends with the mean of its measurements and the difference."""
    if len(values) < LEAST_COLUMNS:
        return False
    position, *measurements, mean, difference = values
    return (
        abs(mean - fmean(measurements)) <= ROUNDED_U
        and abs(difference - (position - mean)) <= ROUNDED_U
    )


def _without_results(place: str, values: list[float]) -> list[float]:
    if not _has_results(values):
        raise UserError(
            f"{place}: the last two columns are not the mean of the measurements and its difference"
            " from the position"
        )
    return values[:-2]


def _numbers(words: Iterable[str]) -> list[float] | None:
    try:
        return [float(word) for word in words]
    except ValueError:
        return None


def errors(setpoint_u: float, values: Iterable[float]) -> float:
    """The entry of a position: setpoint minus the mean of the measured values."""
    return round(setpoint_u - fmean(values), 9)


def wrapped(letter: str, physical: Mapping[float, float], home_u: float) -> Table:
    """A table from physical positions; those below home follow at the end."""
    places = sorted(physical)
    table = Table(letter, tuple((place - home_u, physical[place]) for place in places))
    period = table.period_u
    moved = ((p + period if p < -SAME_U else p, error) for p, error in table.entries)
    return Table(letter, tuple(sorted((round(p, 9), error) for p, error in moved)))


# --- on the card ------------------------------------------------------------------------


def tables_of(store: Store, settings: Settings, folder: Path | None) -> dict[int, Table]:
    """Read the tables enabled in the store; file names are relative to its folder."""
    found = {}
    for axis in settings.axes:
        if not store.read(OFFSETS.ballscrew_on[axis.index]):
            continue
        number = OFFSETS.ballscrew_file[axis.index]
        name = store.read_text(number)
        if not name:
            raise UserError(f"the ballscrew table of {axis.name} is on, but has no file: P{number}")
        found[axis.index] = read((folder or Path()) / name, axis.name)
    return found


def install(card: Card, settings: Settings, tables: Mapping[int, Table]) -> None:
    """Load the tables into the card; a table acts only on a homed axis."""
    program = settings.master
    for axis in settings.axes:
        card.command(f"BSC CLEAR {axis.name}", program=program)
    if not tables:
        return
    laid = {axis: list(_segments(axis, table)) for axis, table in _used(settings, tables)}
    card.command("CLEAR", program=program)  # memory of the program: arrays of another set-up
    card.command(f"DIM LA({sum(map(len, laid.values()))})", program=program)
    array = 0
    for axis, segments in laid.items():
        card.command(f"BSC DIM {axis.name}{len(segments)}", program=program)
        for number, (length, points) in enumerate(segments):
            card.command(f"DIM LA{array}({len(points)})", program=program)
            card.write_array(program, f"LA{array}", points)
            segment = f"({number},{number_text(length)},LA{array})"
            card.command(f"BSC SEG {axis.name}{segment}", program=program)
            array += 1
        preset_cnt = settings.real(HOME.preset[axis.index]) * axis.pulses_per_unit
        begin_cnt = _pulses(axis, tables[axis.index])[0][0]
        shift = number_text(-(begin_cnt + preset_cnt))
        card.command(f"BSC FLZ {axis.name}{shift}", program=program)
    Compensation(card, settings, tables).renew()


class Compensation:
    """Switches the tables on the card: on for homed axes, off for the others."""

    def __init__(self, card: Card, settings: Settings, axes: Iterable[int]) -> None:
        self._card = card
        self._settings = settings
        self._axes = frozenset(axes)

    def renew(self) -> None:
        """Switch every table by its axis: after homing, and after a kill is cleared."""
        for axis in self._settings.axes:
            if axis.index in self._axes:
                state = "ON" if self._settings.is_homed(axis.index) else "OFF"
                self._card.command(f"BSC {state} {axis.name}", program=self._settings.master)


def _used(settings: Settings, tables: Mapping[int, Table]) -> Iterator[tuple[AxisSettings, Table]]:
    return ((axis, tables[axis.index]) for axis in settings.axes if axis.index in tables)


def _pulses(axis: AxisSettings, table: Table) -> Entries:
    """The table in pulses, in ascending order."""
    scale = axis.pulses_per_unit
    return tuple(sorted((p * scale, e * scale) for p, e in table.along(axis.soft_limits)))


def _segments(axis: AxisSettings, table: Table) -> Iterator[tuple[float, list[int]]]:
    """Segments of equal spacing: the length of each and its points, in pulses."""
    entries = _pulses(axis, table)
    runs: list[list[int]] = []
    for k, ((a, _), (b, _)) in enumerate(pairwise(entries)):
        if runs and abs((b - a) - _step(entries, runs[-1])) < SAME_CNT:
            runs[-1].append(k + 1)
        else:
            runs.append([k, k + 1])
    if len(runs) > MOST_SEGMENTS:
        raise UserError(
            f"the ballscrew table of {axis.name} changes its spacing "
            f"{counted(len(runs) - 1, 'time')}; the card takes {MOST_SEGMENTS - 1}"
        )
    for run in runs:
        yield entries[run[-1]][0] - entries[run[0]][0], [round(entries[k][1]) for k in run]


def _step(entries: Entries, run: list[int]) -> float:
    return entries[run[1]][0] - entries[run[0]][0]
