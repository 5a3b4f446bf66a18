"""A card under test: time, conditions, and what it printed and did last."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from openacr.controller import Controller
from openacr.controller.trace import Trace
from openacr.errors import UserError
from openacr.map import find_flag, find_parameter
from openacr.map.explain import object_of
from openacr.map.rows import programs

RUNNING = 1024  # the flag Program Running of PROG0
BITS = 32
EVERY_S = 0.005  # of recorded samples
LOOK_S = 0.01  # between two looks at a condition that is a function
KEPT_S = 20.0  # of the recording, at least
_CONDITION = re.compile(
    r"\s*(P|BIT)\s*(\d+)\s*(<=|>=|<>|=|<|>)\s*(-?[\d.]+(?:[eE]-?\d+)?)\s*", re.I
)
_TESTS: dict[str, Callable[[float, float], bool]] = {
    "<=": lambda left, right: left <= right,
    ">=": lambda left, right: left >= right,
    "<>": lambda left, right: left != right,
    "=": lambda left, right: left == right,
    "<": lambda left, right: left < right,
    ">": lambda left, right: left > right,
}
Condition = str | Callable[[], object]


class NotReachedError(AssertionError):
    """A condition that did not hold in time; the text has the values at the end."""


@dataclass(slots=True)
class Machine:
    """A card with the world around it, recorded while it runs."""

    card: Controller
    project: Path | None = None
    printed: str = ""  # by all programs
    traces: list[Trace] = field(default_factory=list)

    def begin(self) -> None:
        """Record from now on, and hear what programs print."""
        self.card.record(max(1, round(EVERY_S / self.card.period_s)))
        self.card.listen(self._hear)

    def _hear(self, program: int, text: str) -> None:
        self.printed += text

    def send(self, text: str) -> str:
        """Type lines at the console; returns the answer of the card."""
        return self.card.send(text)

    def advance(self, ticks: int = 0, *, seconds: float = 0.0) -> None:
        """Let time pass."""
        whole_s = seconds
        while whole_s > KEPT_S:
            self.card.advance(seconds=KEPT_S)
            whole_s -= KEPT_S
            self._keep()
        self.card.advance(ticks, seconds=whole_s)

    def _keep(self) -> None:
        """Keep the last part of the recording alone."""
        self.traces = [*self.traces[-1:], self.card.take_trace()]

    def until(self, condition: Condition, limit_s: float = 60.0) -> float:
        """Let time pass until a condition holds; returns the seconds it took.

        A condition is a text (`P12290 > 5000`, `BIT516 = 0`), looked at in every tick, or a
        function, looked at every 10 ms. NotReachedError if it does not hold in time.
        """
        begun_s, test, every_s = self.card.time_s, *self._test(condition)
        while not test():
            if self.card.time_s - begun_s >= limit_s:
                raise NotReachedError(self._not_reached(condition, limit_s))
            self.advance(seconds=every_s)
        return self.card.time_s - begun_s

    def _test(self, condition: Condition) -> tuple[Callable[[], object], float]:
        if not isinstance(condition, str):
            return condition, LOOK_S
        found = _CONDITION.fullmatch(condition)
        if found is None:
            raise UserError(
                f"{condition!r}: a condition is P or BIT, its number, one of {' '.join(_TESTS)}"
                " and a value"
            )
        values = self.card.p if found[1].upper() == "P" else self.card.bit
        number, holds, bound = int(found[2]), _TESTS[found[3]], float(found[4])
        return lambda: holds(float(values[number]), bound), self.card.period_s

    def _not_reached(self, condition: Condition, limit_s: float) -> str:
        if not isinstance(condition, str):
            name = getattr(condition, "__name__", repr(condition))
            return f"{name} did not hold within {limit_s:g} s\n{self.state()}"
        found = _CONDITION.fullmatch(condition)
        if found is None:
            return condition
        is_parameter = found[1].upper() == "P"
        number = int(found[2])
        value = self.card.p[number] if is_parameter else int(self.card.bit[number])
        record = (find_parameter if is_parameter else find_flag)(str(number))[0]
        what = f"{found[1].upper()}{number} ({object_of(record)}: {record.name})"
        return f"{condition} did not hold within {limit_s:g} s: {what} is {value:g}\n{self.state()}"

    def state(self) -> str:
        """Time, axes that are on and programs that run, as lines of text."""
        lines = [f"time {self.card.time_s:.4f} s"]
        for number in range(self.card.model.axes):
            axis = self.card.axis(number)
            if self.card.statistics(number).distance_u or axis.following_error:
                lines.append(
                    f"axis {number}: commanded {axis.commanded_u:.6g}, actual {axis.actual_u:.6g},"
                    f" following error {axis.following_error:g} pulses"
                )
        rows = self.card.memory.I
        for program in range(programs.COUNT):
            if self.card.bit[RUNNING + BITS * program]:
                number = rows[programs.line_number[program]]
                where = self.card.origin(program, number)
                place = f"{where[0]}:{where[1]}" if where else f"line {number}"
                lines.append(f"PROG{program} runs at {place}")
        return "\n".join(lines)

    def recorded(self) -> list[Trace]:
        """The recording: its last parts, one after the other."""
        return [*self.traces, self.card.trace()]
