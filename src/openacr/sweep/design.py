"""The points of a sweep: which value each quantity has in each run."""

from __future__ import annotations

import math
from itertools import product
from statistics import NormalDist
from typing import Any

import numpy as np
from numpy.typing import NDArray

from openacr.errors import UserError
from openacr.sweep.schema import Design, Kind, Quantity, Scale
from openacr.sweep.study import Point

CLEAR_OF_ENDS = 1e-12  # of probabilities: a normal distribution has no value at 0 and 1
Cube = NDArray[np.float64]


def points(quantities: dict[str, Quantity], design: Design) -> list[Point]:
    """The points of a design in the order of their runs; equal seeds give equal points."""
    if design.kind is Kind.GRID:
        return list(product(*(steps(each) for each in quantities.values())))
    if design.kind is Kind.LIST:
        return list(zip(*(steps(each) for each in quantities.values()), strict=True))
    cube = _cube(len(quantities), design)
    return [
        tuple(at(quantity, float(u)) for quantity, u in zip(quantities.values(), row, strict=True))
        for row in cube
    ]


def steps(quantity: Quantity) -> tuple[float, ...]:
    """The values of a quantity in a grid or list."""
    if quantity.values is not None:
        return quantity.values
    count = quantity.steps or 2
    return tuple(at(quantity, k / (count - 1)) for k in range(count))


def at(quantity: Quantity, u: float) -> float:
    """The value below which the share `u` (0 to 1) of the values of a quantity lies."""
    if quantity.values is not None:
        return quantity.values[min(int(u * len(quantity.values)), len(quantity.values) - 1)]
    if quantity.normal is not None:
        mean, sigma = quantity.normal
        return NormalDist(mean, sigma).inv_cdf(min(max(u, CLEAR_OF_ENDS), 1.0 - CLEAR_OF_ENDS))
    low, high = quantity.range or (0.0, 1.0)
    if u in (0.0, 1.0):
        return high if u else low
    if quantity.scale is Scale.LOG:
        return math.exp(math.log(low) + u * (math.log(high) - math.log(low)))
    return low + u * (high - low)


def _cube(count: int, design: Design) -> Cube:
    """Points of the unit cube: one row for each run."""
    samples = design.samples or 1
    if design.kind is Kind.RANDOM:
        return np.random.default_rng(design.seed).random((samples, count))
    sobol: Any = _sampler()
    found: Cube = sobol.sample(
        unit_problem(count), samples, calc_second_order=False, scramble=True, seed=design.seed
    )
    return found


def unit_problem(count: int) -> dict[str, Any]:
    """Quantities of a unit cube as SALib describes them."""
    return {
        "num_vars": count,
        "names": [f"x{k}" for k in range(count)],
        "bounds": [[0.0, 1.0]] * count,
    }


def _sampler() -> Any:
    try:
        from SALib.sample import sobol
    except ImportError:
        raise UserError("kind = \"sobol\" needs SALib: pip install 'openacr[sweep]'") from None
    return sobol
