"""The ramp of a gear ratio in closed form, interpreted and compiled alike."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from openacr.compiled import pick
from openacr.kernel.followers import gear_cy
from openacr.map.memory import Memory
from openacr.map.rows import gears

ratios = st.floats(-5, 5)
rates = st.floats(0, 1e4)


def ramp(memory: Memory, goal: float, dt: float, *, pure: bool = False) -> float:
    function = gear_cy.gear_ramp if pure else pick(gear_cy.gear_ramp)
    return function(memory.F, 0, goal, dt, False)


def gear(ratio: float, acc: float, dec: float) -> Memory:
    memory = Memory()
    memory.F[gears.ratio_now[0]] = ratio
    memory.F[gears.acc_rps[0]] = acc
    memory.F[gears.dec_rps[0]] = dec
    return memory


@pytest.mark.parametrize(
    ("start", "goal", "mean", "end"),
    [
        (0.0, 10.0, 0.5, 1.0),
        (0.5, 1.0, 0.875, 1.0),
        (1.0, 0.0, 0.25, 0.0),
        (1.0, -9.0, 0.125, -0.5),
    ],
)
def test_the_mean_of_a_ramp_is_its_area(start: float, goal: float, mean: float, end: float) -> None:
    memory = gear(start, 1.0, 2.0)
    assert ramp(memory, goal, 1.0) == pytest.approx(mean)
    assert memory.F[gears.ratio_now[0]] == pytest.approx(end)


@given(ratios, ratios, rates, rates, st.floats(1e-5, 1.0), st.floats(0.01, 0.99))
def test_a_ramp_cut_in_two_has_the_same_area(
    start: float, goal: float, acc: float, dec: float, dt: float, cut: float
) -> None:
    whole, parts = gear(start, acc, dec), gear(start, acc, dec)
    area = ramp(whole, goal, dt) * dt
    first = ramp(parts, goal, dt * cut) * dt * cut
    second = ramp(parts, goal, dt * (1 - cut)) * dt * (1 - cut)
    assert first + second == pytest.approx(area, rel=1e-6, abs=1e-6)


@given(ratios, ratios, rates, rates, st.floats(1e-5, 1.0))
def test_both_builds_ramp_alike(
    start: float, goal: float, acc: float, dec: float, dt: float
) -> None:
    fast, plain = gear(start, acc, dec), gear(start, acc, dec)
    assert ramp(fast, goal, dt) == ramp(plain, goal, dt, pure=True)
    assert fast.digest() == plain.digest()
