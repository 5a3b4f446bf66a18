"""Samples of all axes over time, recorded by the compiled loop."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import overload

import numpy as np
from numpy.typing import NDArray

from openacr.engine.trace_cy import TRACE_AXIS, TRACE_HEAD

Reals = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class AxisTrace:
    """One axis over time, in its programming units."""

    commanded_u: Reals
    actual_u: Reals
    velocity_ups: Reals
    following_error_u: Reals  # commanded minus actual position


@dataclass(frozen=True, slots=True)
class Trace:
    """A recording: time, onboard inputs and outputs as bit masks, every axis.

    `values` has a column for each additionally chosen value, shape (rows, chosen).
    """

    time_s: Reals
    inputs: NDArray[np.int64]
    outputs: NDArray[np.int64]
    axes: Sequence[AxisTrace]
    values: Reals


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
