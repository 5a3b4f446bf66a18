"""Samples of all axes over time, recorded by the compiled loop."""

from __future__ import annotations

from dataclasses import dataclass

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
    axes: tuple[AxisTrace, ...]
    values: Reals


def build_trace(samples: Reals, pulses_per_unit: list[float]) -> Trace:
    """Name the columns of the raw samples, shape (n, 3 + 4 * axes + chosen values)."""
    axes = []
    for axis, ppu in enumerate(pulses_per_unit):
        first = TRACE_HEAD + TRACE_AXIS * axis
        axes.append(AxisTrace(*(samples[:, first + k] / ppu for k in range(TRACE_AXIS))))
    masks = samples[:, 1:TRACE_HEAD].astype(np.int64) & 0xFFFFFFFF
    values = samples[:, TRACE_HEAD + TRACE_AXIS * len(axes) :]
    return Trace(samples[:, 0], masks[:, 0], masks[:, 1], tuple(axes), values)
