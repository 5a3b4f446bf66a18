"""What matters: how much of the spread of a measure comes from each quantity.

Of a Sobol design these are Sobol's indices (SALib): `first` is the share of the variance that a
quantity causes alone, `total` the share with all its interactions; `_confidence` is half the 95 %
interval. Of other designs it is Spearman's rank correlation.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from openacr.sweep.design import unit_problem
from openacr.sweep.schema import Kind
from openacr.sweep.study import Study

Reals = NDArray[np.float64]


def what_matters(
    study: Study, points: Sequence[Sequence[float]], measures: Reals
) -> dict[str, dict[str, dict[str, float | None]]]:
    """By measure and quantity: indices or a correlation; None where there is none.

    `measures` has a row for each point and a column for each measure, in their order.
    """
    inputs = np.array(points, dtype=float).reshape(len(points), len(study.quantities))
    has_indices = study.optimise is None and study.design.kind is Kind.SOBOL
    found: dict[str, dict[str, dict[str, float | None]]] = {}
    for column, measure in enumerate(study.measures):
        values = measures[:, column]
        if has_indices:
            found[measure] = _indices(study, values)
        else:
            found[measure] = {
                name: {"rank_correlation": _correlation(inputs[:, k], values)}
                for k, name in enumerate(study.quantities)
            }
    return found


def _indices(study: Study, values: Reals) -> dict[str, dict[str, float | None]]:
    keys = {
        "first": "S1",
        "first_confidence": "S1_conf",
        "total": "ST",
        "total_confidence": "ST_conf",
    }
    if not np.all(np.isfinite(values)) or np.ptp(values) == 0.0:
        return {name: dict.fromkeys(keys) for name in study.quantities}
    from SALib.analyze import sobol

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of its table library
        found = sobol.analyze(
            unit_problem(len(study.quantities)),
            values,
            calc_second_order=False,
            seed=study.design.seed,
        )
    return {
        name: {key: float(found[theirs][k]) for key, theirs in keys.items()}
        for k, name in enumerate(study.quantities)
    }


def _correlation(inputs: Reals, values: Reals) -> float | None:
    """Spearman's rank correlation over the runs that have the measure."""
    usable = np.isfinite(values)
    if np.count_nonzero(usable) < 2:
        return None
    left, right = _ranks(inputs[usable]), _ranks(values[usable])
    if np.ptp(left) == 0.0 or np.ptp(right) == 0.0:
        return None
    return float(np.corrcoef(left, right)[0, 1])


def _ranks(values: Reals) -> Reals:
    """Ranks from 0 on; equal values share the mean of theirs."""
    _, which, counts = np.unique(values, return_inverse=True, return_counts=True)
    ends = np.cumsum(counts)
    means: Reals = ends - (counts + 1) / 2.0
    return means[which]
