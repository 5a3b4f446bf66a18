"""A card with its language and its servo tick, driven by typed lines."""

import math

from openacr.basic.channels.session import Session
from openacr.basic.execute.control import ProgramControl
from openacr.basic.execute.executor import Executor
from openacr.basic.execute.system import System
from openacr.basic.language.registry import Level
from openacr.compiled import pick
from openacr.kernel.tick_cy import tick
from openacr.map.names import every_name
from openacr.map.rows import axes as axis_rows
from openacr.map.rows import encoders
from openacr.models import DEFAULT_MODEL, Model
from openacr.motion.axis import attach
from openacr.motion.card import Card

PERIOD_S = 0.0005
WHEEL = encoders.parameters[10]  # of no axis
_tick = pick(tick)


class Bench:
    """Types lines on COM1 at PROG0, where axes 0, 1, ... are named as given."""

    def __init__(self, *axes: str, model: Model = DEFAULT_MODEL) -> None:
        self.card = Card(model)
        self.memory = self.card.memory
        self.system = System(self.card)
        self.executor = Executor(self.system)
        self.system.runner = self.executor
        self.system.control = ProgramControl(self.system, self.executor)
        self.session = self._session("COM1")
        self.session.go(Level.PROG, 0)
        if axes:
            self.attach(0, *enumerate(axes))

    def _session(self, name: str) -> Session:
        session = self.system.sessions[name]
        session.connect()
        session.echo = 4  # no prompts
        return session

    def attach(self, program: int, *axes: tuple[int, str]) -> None:
        """Give a program the master of its number and axes by number and name."""
        attach.master(self.card, program, program)
        for slave, (axis, name) in enumerate(axes):
            attach.slave(self.card, program, slave, axis, name)

    def at(self, level: Level, number: int = 0) -> "Bench":
        """Change the level of the channel."""
        self.session.go(level, number)
        return self

    def type(self, line: str) -> str:
        """What a line prints; lines apart by `|`."""
        self.session.feed_line(line)
        return self.answer()

    def all(self, *lines: str) -> "Bench":
        """Type lines that print nothing."""
        for line in lines:
            assert self.type(line) == "", line
        return self

    def run(self, *lines: str) -> None:
        """Store a program at the present level and start it."""
        self.all("PROGRAM", *lines, "ENDP", "RUN")

    def answer(self) -> str:
        """What has been printed since."""
        text = self.session.take_output().decode("ascii")
        return text.removesuffix("\r\n").replace("\r\n", "|")

    @property
    def is_waiting(self) -> bool:
        """Whether the typed line is not finished yet."""
        return self.session.busy

    def ticks(self, count: int) -> "Bench":
        """Let servo interrupts pass."""
        for _ in range(count):
            _tick(self.memory.F, self.memory.I, self.memory.S)
            self.executor.step(self.card.clock.tick)
        return self

    def seconds(self, time_s: float) -> "Bench":
        """Let time pass."""
        return self.ticks(round(time_s / self.card.clock.period_s))

    def until_clear(self, *flags: int, limit_s: float = 30.0) -> int:
        """Ticks until all of these flags are clear."""
        for count in range(round(limit_s / self.card.clock.period_s)):
            if not any(self.memory.bit(flag) for flag in flags):
                return count
            self.ticks(1)
        raise AssertionError(f"flags {flags} are still set")

    def bit(self, number: int) -> bool:
        """A flag."""
        return self.memory.bit(number)

    def p(self, number: int) -> float:
        """A parameter."""
        return self.memory.read(number)

    def axis(self, axis: int, row: tuple[int, ...]) -> float:
        """A parameter of an axis by its row."""
        return self.memory.read(row[axis])

    def psp(self, axis: int) -> float:
        """Primary setpoint in pulses, unrounded."""
        return self.memory.F[axis_rows.psp_cnt[axis]]

    def place(self, axis: int, **offsets_cnt: float) -> None:
        """Set parts of the setpoint (position, gear, jog, cam) as if motion had left them."""
        row = axis_rows.reals[axis]
        for part, value in offsets_cnt.items():
            self.memory.F[row + every_name()[f"AXF_{part.upper()}_CNT"]] = value
        self.card.show(axis)


def turn(made: Bench, *counts: int) -> Bench:
    """Encoder 10 moves by each of these, tick by tick."""
    for count in counts:
        made.memory.I[WHEEL] += count
        made.ticks(1)
    return made


def ticks(time_s: float, period_s: float = PERIOD_S) -> int:
    """The first tick at or after a time."""
    return math.ceil(time_s / period_s - 1e-9)


def largest(bench: Bench, row: tuple[int, ...], axis: int, *flags: int) -> float:
    """The largest size of an axis parameter until the flags are clear."""
    found = 0.0
    while any(bench.bit(flag) for flag in flags):
        bench.ticks(1)
        found = max(found, abs(bench.axis(axis, row)))
    return found
