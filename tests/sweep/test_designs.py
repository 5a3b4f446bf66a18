"""The points of a sweep: grids, lists and distributions."""

import math

import numpy as np
import pytest

from openacr.sweep.design import at, points
from openacr.sweep.schema import Design, Kind, Quantity, Scale


def line(low: float, high: float, **other: object) -> Quantity:
    return Quantity(parameter=0, range=(low, high), **other)  # type: ignore[arg-type]


def test_a_grid_has_all_combinations_the_last_quantity_first() -> None:
    found = points({"a": line(1, 3, steps=3), "b": Quantity(values=(5.0, 4.0))}, Design())
    assert found == [(1, 5), (1, 4), (2, 5), (2, 4), (3, 5), (3, 4)]


def test_a_list_takes_the_values_side_by_side() -> None:
    quantities = {"a": line(0, 1, steps=3), "b": Quantity(values=(5.0, 4.0, 9.0))}
    assert points(quantities, Design(kind=Kind.LIST)) == [(0, 5), (0.5, 4), (1, 9)]


def test_a_logarithmic_range_has_equal_ratios_and_exact_ends() -> None:
    quantities = {"a": line(0.001, 10, steps=5, scale=Scale.LOG)}
    found = [value for (value,) in points(quantities, Design())]
    assert (found[0], found[-1]) == (0.001, 10)
    assert found[1:4] == pytest.approx([0.01, 0.1, 1.0])


def test_equal_seeds_give_equal_points_and_more_samples_begin_with_the_same() -> None:
    quantities = {"a": line(0, 1), "b": Quantity(normal=(5.0, 2.0))}
    few = points(quantities, Design(kind=Kind.RANDOM, samples=10, seed=4))
    assert points(quantities, Design(kind=Kind.RANDOM, samples=30, seed=4))[:10] == few
    assert points(quantities, Design(kind=Kind.RANDOM, samples=10, seed=5))[0] != few[0]


def test_random_points_have_the_distributions_of_their_quantities() -> None:
    quantities = {
        "a": line(-2, 4), "b": Quantity(normal=(5.0, 2.0)), "c": line(0.01, 100, scale=Scale.LOG),
        "d": Quantity(values=(1.0, 2.0, 4.0)),
    }  # fmt: skip
    found = np.array(points(quantities, Design(kind=Kind.RANDOM, samples=20000)))
    a, b, c, d = found.T
    assert (-2 <= a.min(), a.max() <= 4, a.mean()) == (True, True, pytest.approx(1.0, abs=0.05))
    assert (b.mean(), b.std()) == (pytest.approx(5.0, abs=0.06), pytest.approx(2.0, abs=0.04))
    assert np.median(c) == pytest.approx(1.0, rel=0.1)
    assert [np.mean(d == value) for value in (1, 2, 4)] == pytest.approx([1 / 3] * 3, abs=0.02)


def test_a_normal_distribution_has_its_quantiles() -> None:
    quantity = Quantity(normal=(10.0, 2.0))
    assert at(quantity, 0.5) == 10.0
    assert at(quantity, 0.8413447460685429) == pytest.approx(12.0)
    assert math.isfinite(at(quantity, 0.0)) and math.isfinite(at(quantity, 1.0))


def test_the_last_of_several_values_is_at_the_end() -> None:
    quantity = Quantity(values=(1.0, 2.0, 4.0))
    assert [at(quantity, u) for u in (0.0, 0.34, 0.999, 1.0)] == [1.0, 2.0, 4.0, 4.0]


def test_a_sobol_design_has_a_run_for_each_sample_and_quantity_and_two_more() -> None:
    quantities = {"a": line(0, 1), "b": line(5, 7), "c": Quantity(normal=(0.0, 1.0))}
    found = points(quantities, Design(kind=Kind.SOBOL, samples=8, seed=2))
    assert len(found) == 8 * 5
    assert found == points(quantities, Design(kind=Kind.SOBOL, samples=8, seed=2))
    assert all(0 <= a <= 1 and 5 <= b <= 7 and math.isfinite(c) for a, b, c in found)
