"""Start at line N: the lines before it are interpreted without motion.

Their results - modal state, offsets, parameters, the position, outputs - are collected,
compared with the state of the machine, and applied by the entries of `approach` before the
program continues at line N.

The tool may be deep in a part: a program is started again after an emergency stop in the
cut. So the approach retracts it along the tool axis to a safe level before anything else
moves. That level is the highest one the lines before N bring the tool to at rapid, or one
the operator names. The tool axis is Z in every plane, as it is for the tool length.
"""

from __future__ import annotations

from collections.abc import Generator, Iterator
from dataclasses import dataclass, field
from typing import cast

from openacr.cnc.canonical import (
    AXES,
    TOOL_AXIS,
    Arc,
    Coolant,
    Entry,
    Line,
    Output,
    Pace,
    Point,
    Probe,
    Rapid,
    SetBit,
    Source,
    Spindle,
    Transfer,
)
from openacr.cnc.canonical.actions import Spin
from openacr.cnc.interpreter.interpreter import Interpreter
from openacr.cnc.state.cells import TOOL_IN_SPINDLE
from openacr.cnc.state.hosts import Machine, Switched
from openacr.cnc.state.parameters import OUTPUTS_INVERTED, is_inverted
from openacr.cnc.state.shadow import Shadow
from openacr.errors import UserError

MOST_BLOCKS = 10_000_000
NO_OUTPUT = -1
LIVE = "values of the card were read as they are now"
ABSOLUTE = 90


class StartError(UserError):
    """A line at which the program cannot be started."""


WORDS: dict[str, dict[float, str]] = {
    "spindle": {spin.value: spin.name.lower().replace("_", "-") for spin in Spin},
    "coolant": {0.0: "off", 1.0: "mist", 2.0: "flood", 3.0: "mist and flood"},
    "output": {0.0: "off", 1.0: "on"},
}


def number(value: float) -> str:
    """A number without trailing zeros."""
    return f"{value + 0.0:.4f}".rstrip("0").rstrip(".")


@dataclass(frozen=True, slots=True)
class Difference:
    """Something that is not as the program needs it at line N."""

    name: str
    present: float | Point
    wanted: float | Point

    def shown(self, value: float | Point) -> str:
        """The present or wanted value in words where there are any, else in numbers."""
        if isinstance(value, tuple):
            return " ".join(map(number, value))
        return WORDS.get(self.name.split()[0], {}).get(value) or number(value)


class _Rehearsal:
    """The machine while lines are replayed: nothing moves, trips or is answered."""

    def __init__(self, machine: Machine) -> None:
        self._machine = machine
        self.has_read_card = False
        self.written: dict[int, float] = {}

    def read_parameter(self, n: int) -> float:
        if n in self.written:
            return self.written[n]
        self.has_read_card = True
        return self._machine.read_parameter(n)

    def write_parameter(self, n: int, value: float) -> None:
        self.written[n] = value

    def read_bit(self, n: int) -> bool:
        self.has_read_card = True
        return self._machine.read_bit(n)

    def position(self) -> Point | None:
        return None

    def tripped(self) -> Point | None:
        return None

    def answer(self, parameter: int) -> float | None:
        return self._machine.answer(parameter)

    def is_block_skip_on(self) -> bool:
        return self._machine.is_block_skip_on()

    def is_homed(self, axis: int) -> bool:
        return self._machine.is_homed(axis)

    def has_probe(self) -> bool:
        return self._machine.has_probe()

    def switched(self) -> Switched:
        return self._machine.switched()


@dataclass(slots=True)
class Reached:
    """What the moves of replayed lines say about positions, wherever they began."""

    rapid_level: float | None = None  # the highest they bring the tool axis to at rapid
    by_increments: set[int] = field(default_factory=set)  # axes that know no other positions
    _known: set[int] = field(default_factory=set)  # axes sent to a position

    def note(self, begin: Point, entry: Rapid | Line | Arc | Probe, *, is_absolute: bool) -> None:
        """One move."""
        moved = {axis for axis in range(AXES) if begin[axis] != entry.end[axis]}
        if is_absolute:
            self._known |= moved
            self.by_increments -= moved
        else:
            self.by_increments |= moved - self._known
        if isinstance(entry, Rapid) and TOOL_AXIS in self._known:
            level = entry.end[TOOL_AXIS]
            self.rapid_level = level if self.rapid_level is None else max(level, self.rapid_level)


@dataclass(slots=True)
class Replay:
    """The state before line N; `entries` begin with the approach."""

    run: Interpreter
    line: int
    present: Point
    shadow: Shadow
    differences: list[Difference] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    outputs: dict[int, Output] = field(default_factory=dict)
    bits: dict[int, SetBit] = field(default_factory=dict)
    variables: dict[int, float] = field(default_factory=dict)  # of the card
    reached: Reached = field(default_factory=lambda: Reached())
    level: float | None = None  # where the tool is free, as the operator says

    @property
    def needs_tool(self) -> bool:
        """The tool in the spindle is not the one the program has there."""
        return any(difference.name == "tool" for difference in self.differences)

    def entries(self) -> Iterator[Entry]:
        """The approach, then the program from line N on; parameters are written now."""
        self.present = self.run.machine.position() or self.present
        approach = list(self.approach())
        self.shadow.commit()
        for n, value in self.variables.items():
            self.run.machine.write_parameter(n, value)
        yield from approach
        yield from self.run.go_on()

    def approach(self) -> Iterator[Entry]:
        """Tool up to a safe level, the others over, spindle and coolant on, down at feed."""
        modal, wanted = self.run.modal, self.run.path.issued
        source = Source(self.run.program.main.text.name, self.line, "")
        level = self.safe_level()
        yield Rapid(source, _at_level(self.present, level), is_inserted=True)
        yield Rapid(source, _at_level(wanted, level), is_inserted=True)
        yield Spindle(source, modal.spin, modal.speed)
        yield Coolant(source, modal.mist, modal.flood)
        yield from self.outputs.values()
        yield from self.bits.values()
        yield Line(source, wanted, Pace(modal.feed), is_inserted=True)

    def safe_level(self) -> float:
        """The level of the tool axis at which the others move; never lower than the tool.

        StartError where they have to and nothing says at which level the tool is free.
        """
        wanted = self.run.path.issued
        free = [each for each in (self.reached.rapid_level, self.level) if each is not None]
        moves_over = _at_level(self.present, 0.0) != _at_level(wanted, 0.0)
        if moves_over and not free and TOOL_AXIS in self.run.planner.axes.values():
            raise StartError(
                f"line {self.line}: no line before it brings Z at rapid to a level where the tool"
                " is free: its machine position has to be given (Safe Z, --safe-z)"
            )
        return max(self.present[TOOL_AXIS], wanted[TOOL_AXIS], *free)


def _at_level(point: Point, level: float) -> Point:
    """A point with the tool axis at a level."""
    return (*point[:TOOL_AXIS], level, *point[TOOL_AXIS + 1 :])


Rehearsal = Generator[None, None, "Replay"]


def start_at(run: Interpreter, line: int, level: float | None = None) -> Replay:
    """Replay everything before a line at once, as `rehearsal` does piece by piece."""
    replaying = rehearsal(run, line, level)
    while True:
        try:
            next(replaying)
        except StopIteration as done:
            return cast(Replay, done.value)


def rehearsal(run: Interpreter, line: int, level: float | None = None) -> Rehearsal:
    """Replay everything before a line, step by step; StartError if it is never reached.

    `level`: the machine position of the tool axis at which the tool is free, in default units;
    StartError where the approach needs one and neither it nor the lines name it.
    The cells of the interpreter have to be a Shadow: they are written when it goes on.
    """
    last = run.program.line_cnt
    if not 1 <= line <= last:
        raise StartError(f"line {line}: the program has lines 1 to {last}")
    if not isinstance(run.cells, Shadow):
        raise TypeError("a replay needs cells of its own")
    machine = run.machine
    present = machine.position() or run.path.target
    tool = run.cells.read(TOOL_IN_SPINDLE)
    host = _Rehearsal(machine)
    run.machine = host
    replay = Replay(run, line, present, run.cells, variables=host.written, level=level)
    try:
        yield from _rehearse(replay, line)
    finally:
        run.machine = machine
    if host.has_read_card:
        replay.warnings.append(LIVE)
    if replay.reached.by_increments:
        replay.warnings.append(_increments(replay))
    replay.safe_level()  # a start that would be refused is not asked about
    replay.differences += _differences(replay, tool)
    return replay


def _rehearse(replay: Replay, line: int) -> Iterator[None]:
    run, place = replay.run, replay.present
    for count, entry in enumerate(run.entries_until(line)):
        yield
        if count > MOST_BLOCKS:
            raise StartError(f"line {line} is not reached within {MOST_BLOCKS} steps")
        match entry:
            case Rapid() | Line() | Arc() | Probe():
                is_absolute = run.modal.distance == ABSOLUTE
                replay.reached.note(place, entry, is_absolute=is_absolute)
                place = entry.end
            case Output() if entry.number != NO_OUTPUT:
                replay.outputs[entry.number] = entry
            case SetBit():
                replay.bits[entry.bit] = entry
            case Transfer():
                replay.variables[entry.parameter] = entry.value
    if not run.execution.is_arrived:
        raise StartError(f"line {line} is never reached")
    if run.flow.frames:
        raise StartError(f"line {line} belongs to a subroutine")


def _increments(replay: Replay) -> str:
    names = {axis: letter for letter, axis in replay.run.planner.axes.items()}
    listed = " ".join(names[axis] for axis in sorted(replay.reached.by_increments))
    return f"{listed}: increments were counted from where the machine is now"


def _differences(replay: Replay, tool: float) -> Iterator[Difference]:
    modal, run = replay.run.modal, replay.run
    now = run.machine.switched()
    pairs = (
        ("tool", tool, float(modal.tool_in_spindle)),
        ("S", now.rpm, modal.speed),
        ("spindle", float(now.spin.value), float(modal.spin.value)),
        ("coolant", now.has_mist + 2.0 * now.has_flood, modal.mist + 2.0 * modal.flood),
        ("work system", 1.0, float(modal.work)),
        ("H", 0.0, float(modal.length_number)),
        ("D", 0.0, float(modal.radius_number)),
    )
    for name, present, wanted in pairs:
        if present != wanted:
            yield Difference(name, present, wanted)
    for output in replay.outputs.values():
        bit = output.is_on != is_inverted(run.cells, OUTPUTS_INVERTED, output.number)
        if run.machine.read_bit(output.number) != bit:
            is_on = float(output.is_on)
            yield Difference(f"output {output.number}", 1.0 - is_on, is_on)
    if run.path.issued != replay.present:
        yield Difference("position", replay.present, run.path.issued)
