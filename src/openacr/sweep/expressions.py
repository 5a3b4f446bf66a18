"""Measures: expressions over what was recorded of a run, whose result is one number.

`AXIS0.following_error`, `P12290` and `BIT516` are series, one value for each recorded tick, in
the units of the axis or parameter; functions make numbers of them. Names of quantities and of the
measures above are numbers.
"""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from enum import Enum
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from openacr.errors import UserError

Series = NDArray[np.float64]
Value = float | Series
SERIES = ("commanded", "actual", "velocity", "following_error")
TOTALS = ("peak_following_error", "peak_velocity", "distance")
_NUMBERS = (int, float)
_NUMBERED = re.compile(r"(P|BIT|AXIS)(\d{1,7})")


class Kind(Enum):
    """What an expression gives: a number, or a value for each recorded tick."""

    NUMBER = "a number"
    SERIES = "a series"


class Recorded(Protocol):
    """What was recorded of a run."""

    @property
    def time_s(self) -> Series:
        """The times of the rows, from the start of the run."""

    @property
    def end_s(self) -> float:
        """The length of the run."""

    @property
    def period_s(self) -> float:
        """The time between two rows."""

    def axis(self, number: int, name: str) -> Value:
        """A series (SERIES) or a total (TOTALS) of an axis."""

    def series(self, name: str) -> Series:
        """A recorded parameter or flag: `P12290`."""

    def present(self, name: str) -> float:
        """A parameter, a flag or a value of an axis at the end of the run."""


@dataclass(slots=True)
class Needs:
    """What is to be recorded so that measures can be evaluated."""

    axes: set[int] = field(default_factory=set)
    samples: set[str] = field(default_factory=set)  # P12290, BIT516
    ends: set[str] = field(default_factory=set)  # of these the value at the end
    has_series: bool = False


def _first(times: Series, holds: Series) -> float:
    found = np.flatnonzero(holds)
    return float(times[found[0]]) if len(found) else math.nan


def _last(times: Series, holds: Series) -> float:
    found = np.flatnonzero(holds)
    return float(times[found[-1]]) if len(found) else math.nan


def _settling(times: Series, values: Series, band: float, since_s: float = 0.0) -> float:
    """Seconds from `since_s` until |values| stays within the band; NaN if it does not."""
    outside = np.flatnonzero((np.abs(values) > band) & (times >= since_s))
    if not len(outside):
        return 0.0
    last = int(outside[-1])
    return math.nan if last + 1 == len(times) else float(times[last + 1]) - since_s


def _rms(values: Series) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


# By name: how many arguments, and of which kinds; then what it does with rows and arguments.
_ELEMENT: dict[str, Callable[[Any], Any]] = {
    "abs": np.abs, "sqrt": np.sqrt, "exp": np.exp, "log": np.log, "sin": np.sin, "cos": np.cos,
}  # fmt: skip
_REDUCE: dict[str, Callable[[Series], float]] = {
    "max": lambda values: float(np.max(values)),
    "min": lambda values: float(np.min(values)),
    "mean": lambda values: float(np.mean(values)),
    "rms": _rms,
    "ever": lambda values: float(np.any(values)),
}
_TIMED: dict[str, Callable[..., float]] = {
    "first_time": _first,
    "last_time": _last,
    "settling_time": _settling,
}
_LENGTHS: dict[str, Callable[[Series, float], float]] = {
    "duration": lambda values, period_s: float(np.count_nonzero(values)) * period_s,
    "integral": lambda values, period_s: float(np.sum(values)) * period_s,
}
FUNCTIONS = (*_ELEMENT, *_REDUCE, *_TIMED, *_LENGTHS, "at_end")
_OPERATORS: dict[type[ast.AST], Callable[[Any, Any], Any]] = {
    ast.Add: np.add, ast.Sub: np.subtract, ast.Mult: np.multiply, ast.Div: np.divide,
    ast.Pow: np.power, ast.Lt: np.less, ast.LtE: np.less_equal, ast.Gt: np.greater,
    ast.GtE: np.greater_equal, ast.Eq: np.equal, ast.NotEq: np.not_equal,
    ast.And: np.logical_and, ast.Or: np.logical_or,
}  # fmt: skip


class Measure:
    """One expression, checked; `names` are the numbers it may use."""

    def __init__(self, text: str, names: frozenset[str], needs: Needs) -> None:
        """UserError for what is no expression, or does not give a number."""
        self._names = names
        self._needs = needs
        try:
            self._tree = ast.parse(text.strip(), mode="eval").body
            kind = self._kind(self._tree)
        except (SyntaxError, ValueError, OverflowError, RecursionError, MemoryError):
            raise UserError(f"{text!r} is not an expression that can be read") from None
        if kind is Kind.SERIES:
            raise UserError(
                f"{text!r} is a value for each tick; a measure is one number: max(...), at_end(...)"
            )

    def value(self, recorded: Recorded, numbers: Mapping[str, float]) -> float:
        """The measure of a run; NaN where it has none (a time that never came, 0/0)."""
        with np.errstate(all="ignore"):
            return float(_value(self._tree, recorded, numbers))

    def _kind(self, node: ast.AST) -> Kind:
        """What a part gives; UserError for a part that no expression has."""
        if isinstance(node, ast.Constant) and type(node.value) in _NUMBERS:
            float(node.value)  # type: ignore[arg-type]
            return Kind.NUMBER
        if isinstance(node, ast.Name | ast.Attribute):
            return self._named(node)
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub | ast.UAdd | ast.Not):
            return self._kind(node.operand)
        if isinstance(node, ast.BinOp) and type(node.op) in _OPERATORS:
            return self._wider(node.left, node.right)
        if isinstance(node, ast.BoolOp):
            return self._wider(*node.values)
        if isinstance(node, ast.Compare) and len(node.ops) == 1 and type(node.ops[0]) in _OPERATORS:
            return self._wider(node.left, node.comparators[0])
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and not node.keywords:
            return self._called(node.func.id, node.args)
        raise UserError(
            f"{ast.unparse(node)!r} cannot be part of a measure (numbers, names, + - * / **,"
            " comparisons, and, or, not, functions)"
        )

    def _wider(self, *parts: ast.AST) -> Kind:
        kinds = [self._kind(part) for part in parts]
        return Kind.SERIES if Kind.SERIES in kinds else Kind.NUMBER

    def _named(self, node: ast.Name | ast.Attribute) -> Kind:
        name = ast.unparse(node)
        if name in self._names or name == "end_time":
            return Kind.NUMBER
        if name == "time":
            self._needs.has_series = True
            return Kind.SERIES
        whole, _, quantity = name.partition(".")
        numbered = _NUMBERED.fullmatch(whole)
        if numbered and numbered[1] == "AXIS":
            return self._of_axis(int(numbered[2]), quantity)
        if numbered and not quantity:
            self._needs.samples.add(name)
            self._needs.has_series = True
            return Kind.SERIES
        raise UserError(
            f"there is no {name!r}; known are time, end_time, AXIS0.following_error, P12290, BIT516"
            f" and {', '.join(sorted(self._names))}"
        )

    def _of_axis(self, number: int, quantity: str) -> Kind:
        if quantity not in (*SERIES, *TOTALS):
            raise UserError(
                f"an axis has no {quantity!r}; it has {', '.join((*SERIES, *TOTALS))}"
                if quantity
                else f"AXIS{number} alone is no value; write AXIS{number}.following_error"
            )
        self._needs.axes.add(number)
        if quantity in TOTALS:
            return Kind.NUMBER
        self._needs.has_series = True
        return Kind.SERIES

    def _called(self, name: str, arguments: list[ast.expr]) -> Kind:
        if name not in FUNCTIONS:
            raise UserError(f"there is no function {name!r}; known are {', '.join(FUNCTIONS)}")
        if name == "at_end":
            return self._at_end(arguments)
        if name in ("max", "min") and len(arguments) > 1:
            if any(self._kind(each) is Kind.SERIES for each in arguments):
                raise UserError(f"{name} of several values takes numbers only")
            return Kind.NUMBER
        least, most = (2, 3) if name == "settling_time" else (1, 1)
        if not least <= len(arguments) <= most:
            raise UserError(f"{name} takes {least if least == most else '2 or 3'} values")
        kinds = [self._kind(each) for each in arguments]
        if name in _ELEMENT:
            return kinds[0]
        if kinds[0] is Kind.NUMBER:
            raise UserError(f"{name} needs a value for each tick, such as AXIS0.velocity")
        if Kind.SERIES in kinds[1:]:
            raise UserError(f"{name}: only its first value may be one for each tick")
        return Kind.NUMBER

    def _at_end(self, arguments: list[ast.expr]) -> Kind:
        text = ast.unparse(arguments[0]) if len(arguments) == 1 else ""
        whole, _, quantity = text.partition(".")
        numbered = _NUMBERED.fullmatch(whole)
        is_axis = numbered is not None and numbered[1] == "AXIS"
        if numbered is None or (quantity not in SERIES if is_axis else quantity):
            raise UserError(
                "at_end takes a parameter, a flag, or a value of an axis: at_end(P12290)"
            )
        if is_axis:
            self._needs.axes.add(int(numbered[2]))
        else:
            self._needs.ends.add(text)
        return Kind.NUMBER


def _value(node: Any, recorded: Recorded, numbers: Mapping[str, float]) -> Any:
    """Evaluate a part that was checked."""
    if isinstance(node, ast.Constant):
        return float(node.value)  # type: ignore[arg-type]
    if isinstance(node, ast.Name | ast.Attribute):
        return _of_name(ast.unparse(node), recorded, numbers)
    if isinstance(node, ast.UnaryOp):
        inner = _value(node.operand, recorded, numbers)
        if isinstance(node.op, ast.Not):
            return np.logical_not(inner)
        return -inner if isinstance(node.op, ast.USub) else inner
    if isinstance(node, ast.BinOp):
        left, right = (_value(each, recorded, numbers) for each in (node.left, node.right))
        return _OPERATORS[type(node.op)](left, right)
    if isinstance(node, ast.BoolOp):
        found = [_value(each, recorded, numbers) for each in node.values]
        for other in found[1:]:
            found[0] = _OPERATORS[type(node.op)](found[0], other)
        return found[0]
    if isinstance(node, ast.Compare):
        parts = (node.left, node.comparators[0])
        left, right = (_value(each, recorded, numbers) for each in parts)
        return _OPERATORS[type(node.ops[0])](left, right)
    return _result(node.func.id, node.args, recorded, numbers)


def _of_name(name: str, recorded: Recorded, numbers: Mapping[str, float]) -> Value:
    if name in numbers:
        return numbers[name]
    if name == "time":
        return recorded.time_s
    if name == "end_time":
        return recorded.end_s
    if name.startswith("AXIS"):
        whole, _, quantity = name.partition(".")
        return recorded.axis(int(whole[4:]), quantity)
    return recorded.series(name)


def _result(
    name: str, arguments: list[ast.expr], recorded: Recorded, numbers: Mapping[str, float]
) -> Value:
    if name == "at_end":
        return recorded.present(ast.unparse(arguments[0]))
    values = [_value(each, recorded, numbers) for each in arguments]
    if len(values) > 1 and name in ("max", "min"):
        return float(max(values) if name == "max" else min(values))
    if name in _ELEMENT:
        return _ELEMENT[name](values[0])  # type: ignore[no-any-return]
    if name in _REDUCE:
        return _REDUCE[name](values[0])
    if name in _TIMED:
        return _TIMED[name](recorded.time_s, *values)
    return _LENGTHS[name](values[0], recorded.period_s)
