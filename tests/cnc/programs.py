"""Run part programs in tests and show what comes out, one short text per entry."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from openacr.cnc.canonical import (
    Arc,
    Entry,
    Line,
    Moves,
    Point,
    Polyline,
    Probe,
    Rapid,
    SetCell,
    Source,
    Sync,
    Tapping,
    Transfer,
)
from openacr.cnc.interpreter.interpreter import Interpreter, Options
from openacr.cnc.loading.load import Folders, load
from openacr.cnc.reading.findings import BlockError, Finding
from openacr.cnc.state.hosts import VirtualMachine
from openacr.cnc.state.shadow import Shadow
from openacr.conform import entries
from openacr.sysvar import Store

STORE = Store()
CYCLES = "\nM2\n$I CYCLES.TXT\n"
LETTERS = "XYZABCUV"


@dataclass
class Bench(VirtualMachine):
    """A machine whose probe trips and operator answers as given."""

    trip: Point | None = None
    answers: dict[int, float] = field(default_factory=dict)
    where: Point | None = None

    def tripped(self) -> Point | None:
        return self.trip

    def answer(self, parameter: int) -> float | None:
        return self.answers.get(parameter)

    def position(self) -> Point | None:
        return self.where


@dataclass
class Run:
    """What a program did."""

    entries: list[Entry]
    interpreter: Interpreter
    cells: Shadow
    machine: Bench
    error: Finding | None = None

    @property
    def moves(self) -> list[str]:
        """Motion alone, as `R X1 Y2` (rapid), `L`, `A`, `P`: axes that are not 0."""
        return [shown(e) for e in self.entries if isinstance(e, Rapid | Line | Arc | Probe)]

    @property
    def ends(self) -> list[tuple[float, ...]]:
        """X, Y, Z of every move."""
        moves = [e for e in self.entries if isinstance(e, Rapid | Line | Arc | Probe)]
        return [tuple(round(x, 9) + 0.0 for x in e.end[:3]) for e in moves]

    @property
    def story(self) -> list[str]:
        """All entries, without syncs."""
        return [shown(e) for e in self.entries if not isinstance(e, Sync)]

    @property
    def codes(self) -> list[str]:
        """Warnings of load and run."""
        findings = [*self.interpreter.program.findings, *self.interpreter.warnings]
        return [finding.code for finding in findings]

    def p(self, n: int) -> float:
        """A parameter afterwards."""
        return self.interpreter.parameters.read_p(n)

    def of(self, kind: type[Entry]) -> list[Entry]:
        """Entries of a kind."""
        return [entry for entry in self.entries if isinstance(entry, kind)]


def at(point: Point) -> str:
    """The axes of a point that are not 0."""
    words = [
        f"{letter}{round(x, 6):g}"
        for letter, x in zip(LETTERS, point, strict=True)
        if abs(x) > 1e-9
    ]
    return " ".join(words) or "0"


def shown(entry: Entry) -> str:
    """One entry in short."""
    match entry:
        case Rapid():
            return f"R {at(entry.end)}"
        case Line():
            return f"L {at(entry.end)}"
        case Probe():
            return f"P {at(entry.end)}"
        case Arc():
            x, y = (round(value, 6) + 0.0 for value in entry.centre)
            centre = f"{x:g},{y:g}"
            return f"A {at(entry.end)} about {centre} {round(entry.sweep_rad * 57.29577951308232)}"
        case Transfer():
            return f"P{entry.parameter}={entry.value:g}"
        case SetCell() | Tapping():
            return type(entry).__name__
        case _:
            return entries.shown(entry)


def made(
    text: str | Path,
    cells: dict[int, float] | None = None,
    *,
    start: tuple[float, ...] = (0.0, 0.0, 0.0),
    axes: int = 3,
    dialect: str = "acromill",
    options: Options | None = None,
    machine: Bench | None = None,
    folders: Folders | None = None,
) -> Run:
    """Load a program and make its interpreter; nothing has run yet."""
    shadow = Shadow(Shadow(STORE))  # what a replay commits stays in the inner one
    for axis in range(8):
        shadow.write(200_012 + 1000 * axis, float(axis < axes))
    for n, value in (cells or {}).items():
        shadow.write(n, value)
    machine = machine or Bench()
    program = load(text, shadow, dialect, folders)
    interpreter = Interpreter(program, shadow, machine, dialect, options)
    for n, value in (cells or {}).items():
        if n >= 100:
            shadow.write(n, value)
        else:
            machine.parameters[n] = value
    interpreter.path.begin((*start, *(0.0,) * (8 - len(start))))
    return Run([], interpreter, shadow, machine)


def run(
    text: str | Path,
    cells: dict[int, float] | None = None,
    *,
    start: tuple[float, ...] = (0.0, 0.0, 0.0),
    axes: int = 3,
    dialect: str = "acromill",
    options: Options | None = None,
    machine: Bench | None = None,
    folders: Folders | None = None,
) -> Run:
    """Run a program to its end or first error; load errors are an AssertionError."""
    done = made(
        text,
        cells,
        start=start,
        axes=axes,
        dialect=dialect,
        options=options,
        machine=machine,
        folders=folders,
    )
    errors = done.interpreter.program.errors
    if errors:
        raise AssertionError("; ".join(map(str, errors)))
    try:
        done.entries.extend(unrolled(done.interpreter.entries()))
    except BlockError as error:
        done.error = error.finding
    return done


def unrolled(entries: Iterator[Entry]) -> Iterator[Entry]:
    """The entries with many moves as single ones."""
    for entry in entries:
        if isinstance(entry, Moves):
            yield from entry.entries()
        elif isinstance(entry, Polyline):
            for end, line in zip(entry.ends, entry.lines, strict=True):
                source = Source(entry.source.file, int(line), "")
                yield Line(source, tuple(float(x) for x in end), entry.pace)
        else:
            yield entry


def errors(text: str | Path, cells: dict[int, float] | None = None, **more: object) -> list[str]:
    """Codes of errors at load, or the one at run time."""
    done = made(text, cells, **more)  # type: ignore[arg-type]
    found = done.interpreter.program.errors
    if found:
        return [finding.code for finding in found]
    try:
        for _ in done.interpreter.entries():
            pass
    except BlockError as error:
        return [error.finding.code]
    return []
