"""Samples of all axes over time, recorded by the compiled loop."""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
from typing import Any, overload

import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from openacr.controller.pages import table
from openacr.engine.trace_cy import TRACE_AXIS, TRACE_HEAD
from openacr.errors import UserError
from openacr.wording import counted

Reals = NDArray[np.float64]
QUANTITIES = ("commanded", "actual", "velocity", "following_error")
EXTREMES = ("axis", "lowest [units]", "highest [units]", "peak velocity [units/s]",
            "peak following error [units]")  # fmt: skip


class AxisTrace(Struct, frozen=True):
    """One axis over time, in its programming units."""

    commanded_u: Reals
    actual_u: Reals
    velocity_ups: Reals
    following_error_u: Reals  # commanded minus actual position


class Trace(Struct, frozen=True):
    """A recording: time, onboard inputs and outputs as bit masks, every axis.

    `values` has a column for each additionally chosen value, shape (rows, chosen).
    """

    time_s: Reals
    inputs: NDArray[np.int64]
    outputs: NDArray[np.int64]
    axes: Sequence[AxisTrace]
    values: Reals

    def columns(self) -> dict[str, NDArray[Any]]:
        """Every column by its name, as a file of `openacr run --trace` has them.

        `time_s`, `inputs` and `outputs`, for each axis `axis_0_commanded`, `axis_0_actual` (units),
        `axis_0_velocity` (units/s) and `axis_0_following_error` (units), then `value_0` ... for
        the chosen values.
        """
        found: dict[str, NDArray[Any]] = {
            "time_s": self.time_s,
            "inputs": self.inputs,
            "outputs": self.outputs,
        }
        for number, axis in enumerate(self.axes):
            reals = (axis.commanded_u, axis.actual_u, axis.velocity_ups, axis.following_error_u)
            for quantity, column in zip(QUANTITIES, reals, strict=True):
                found[f"axis_{number}_{quantity}"] = column
        return found | {f"value_{place}": column for place, column in enumerate(self.values.T)}

    def to_pandas(self) -> Any:
        """The columns as a DataFrame of pandas, indexed by time [s]; UserError without pandas."""
        found = _package("pandas").DataFrame(self.columns())
        return found.set_index("time_s")

    def to_arrow(self) -> Any:
        """The columns as a Table of Apache Arrow; UserError without pyarrow."""
        return _package("pyarrow").table(self.columns())

    def _repr_html_(self) -> str:
        """What notebooks show: rows, time, and the extremes of each axis that has moved."""
        span = f"{self.time_s[0]:g} to {self.time_s[-1]:g} s" if len(self.time_s) else "empty"
        rows = [
            (number, *(f"{value:.6g}" for value in _extremes(axis)))
            for number, axis in enumerate(self.axes)
            if len(self.time_s) and np.ptp(axis.actual_u) > 0.0
        ]
        return f"<p>Trace: {counted(len(self.time_s), 'row')}, {span}</p>{table(EXTREMES, rows)}"


def _extremes(axis: AxisTrace) -> tuple[float, ...]:
    peaks = (np.abs(column).max() for column in (axis.velocity_ups, axis.following_error_u))
    return (axis.actual_u.min(), axis.actual_u.max(), *peaks)


def _package(name: str) -> Any:
    """A package that only some users have; UserError with how to get it."""
    try:
        return import_module(name)
    except ImportError:
        raise UserError(f"{name} is not installed: python -m pip install {name}") from None


class _Axes(Sequence[AxisTrace]):
    """The axes of raw samples; only those that are used are copied and scaled."""

    def __init__(self, samples: Reals, pulses_per_unit: list[float]) -> None:
        self._samples, self._scales = samples, pulses_per_unit
        self._made: dict[int, AxisTrace] = {}

    def __len__(self) -> int:
        return len(self._scales)

    @overload
    def __getitem__(self, index: int) -> AxisTrace: ...

    @overload
    def __getitem__(self, index: slice) -> tuple[AxisTrace, ...]: ...

    def __getitem__(self, index: int | slice) -> AxisTrace | tuple[AxisTrace, ...]:
        axes = range(len(self))[index]
        return self._axis(axes) if isinstance(axes, int) else tuple(map(self._axis, axes))

    def _axis(self, axis: int) -> AxisTrace:
        if axis not in self._made:
            first = TRACE_HEAD + TRACE_AXIS * axis
            columns = (self._samples[:, first + k] for k in range(TRACE_AXIS))
            self._made[axis] = AxisTrace(*(column / self._scales[axis] for column in columns))
        return self._made[axis]


def build_trace(samples: Reals, pulses_per_unit: list[float]) -> Trace:
    """Name the columns of the raw samples, shape (n, 3 + 4 * axes + chosen values)."""
    axes = _Axes(samples, pulses_per_unit)
    masks = samples[:, 1:TRACE_HEAD].astype(np.int64) & 0xFFFFFFFF
    values = samples[:, TRACE_HEAD + TRACE_AXIS * len(axes) :]
    return Trace(samples[:, 0], masks[:, 0], masks[:, 1], axes, values)
