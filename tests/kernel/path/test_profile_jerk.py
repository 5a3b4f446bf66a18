"""Coordinated moves with JRK: jerk bounded, time near the optimum, limits under disturbance."""

import numpy as np
import pytest
import ruckig
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.kernel import oracle
from tests.kernel.path.test_profile import disturbed, set_up, shapes, spread, ticks_moved
from tests.kernel.rig import Rig, T, acceleration, jerk, noise, velocity
from tests.search import examples, search

pytestmark = pytest.mark.evidence("oracle", "the fastest trajectory of ruckig")

settings.load_profile("kernel")


@st.composite
def curves(draw: st.DrawFn) -> dict[str, float]:
    """A move from rest to rest with jerk, ACC and STP above 0."""
    shape = draw(shapes())
    shape["acc"] = shape["vel"] / draw(spread(2e-3, 0.5))
    shape["jrk"] = shape["acc"] / draw(spread(2e-3, 0.5))
    shape["fvel"] = shape["ivel"] = 0.0
    return shape


@search(400)
@given(curves())
def test_an_s_curve_ends_exactly_keeps_its_jerk_and_takes_the_closed_form_time(
    shape: dict[str, float],
) -> None:
    rig = Rig(ppu=[100.0])
    shape = set_up(shape, rig)
    rig.move(shape["length"])
    positions = rig.record()
    assert positions[-1] == positions[-2] == shape["length"] * 100
    assert np.all(np.diff(positions) >= 0)
    units = positions / 100
    assert velocity(units).max() <= shape["vel"] * (1 + 1e-6) + noise(units, 1)
    strongest = max(shape["acc"], shape["stp"])
    assert np.abs(acceleration(units)).max() <= strongest * (1 + 1e-6) + noise(units, 2)
    assert np.abs(jerk(units)).max() <= shape["jrk"] * (1 + 1e-6) + noise(units, 3)
    leg = oracle.move(
        shape["length"], shape["vel"], shape["acc"], 0, shape["stp"], jerk=shape["jrk"]
    )
    assert abs(ticks_moved(positions) - leg.time / T) <= 1 + 1e-6 * leg.time / T


@search(300)
@given(curves())
def test_an_s_curve_is_at_most_a_hundredth_slower_than_the_optimum(
    shape: dict[str, float],
) -> None:
    shape["stp"] = shape["acc"]
    rig = Rig()
    shape = set_up(shape, rig)
    rig.move(shape["length"])
    positions = rig.record()
    unit_s = shape["length"] / shape["vel"]  # in lengths and this time ruckig is at ease
    wanted = ruckig.InputParameter(1)
    wanted.current_position, wanted.target_position = [0.0], [1.0]
    wanted.max_velocity = [1.0]
    wanted.max_acceleration = [shape["acc"] * unit_s / shape["vel"]]
    wanted.max_jerk = [shape["jrk"] * unit_s**2 / shape["vel"]]
    best = ruckig.Trajectory(1)
    ruckig.Ruckig(1).calculate(wanted, best)
    optimum_s = best.duration * unit_s
    moved = ticks_moved(positions) * T
    assert optimum_s - T <= moved <= optimum_s * 1.01 + T


@search(300)
@given(curves(), st.data())
def test_overrides_and_holds_during_an_s_curve_keep_end_acceleration_and_jerk(
    shape: dict[str, float], data: st.DataObject
) -> None:
    rig = Rig(ppu=[1000.0])
    shape["dec"] = shape["dec"] or shape["stp"]
    shape = set_up(shape, rig)
    units = disturbed(rig, shape, data)
    assert units[-1] == shape["length"] * 1000
    units = units / 1000
    assert np.all(np.diff(units) >= -noise(units, 0))
    strongest = max(shape[r] for r in ("acc", "dec", "stp"))
    assert np.abs(acceleration(units)).max() <= strongest * (1 + 1e-6) + noise(units, 2)
    assert np.abs(jerk(units)).max() <= shape["jrk"] * (1 + 1e-6) + noise(units, 3)


@pytest.mark.search
def test_an_s_curve_that_brakes_for_a_lower_override_goes_on_braking_at_its_end() -> None:
    """Released so late that taking the brake off first would pass the target."""
    for ticks in range(0, 900, 900 // examples(130)):
        rig = Rig(ppu=[1000.0]).master(acc=100, dec=100, stp=100, jrk=1000, vel=50)
        rig.move(10.0)
        positions = [0.0]
        for tick in range(ticks):
            positions.append(rig.ticks().real("psp_cnt"))
            if tick == ticks // 2:
                rig.master(fov=0.1)
        rig.master(fov=1.0)
        units = np.array([*positions[:-1], *rig.record()]) / 1000
        assert units[-1] == 10.0
        assert np.abs(acceleration(units)).max() <= 100 * (1 + 1e-6)
        assert np.abs(jerk(units)).max() <= 1000 * (1 + 1e-5)


@search(150)
@given(st.lists(curves(), min_size=2, max_size=3))
def test_merged_s_curves_pass_on_speed_and_acceleration(chain: list[dict[str, float]]) -> None:
    rig = Rig(ppu=[100.0])
    rig.depth(5)
    scale, first = 0.0, chain[0]
    acc, jrk = first["acc"], first["jrk"]
    for number, shape in enumerate(chain):
        last = number + 1 == len(chain)
        vel = first["vel"] * (0.2 + number % 2)
        rig.master(acc=acc, dec=acc, stp=acc if last else 0.0, jrk=jrk, vel=vel)
        scale += first["length"] * (0.2 + shape["length"] % 1.0)
        rig.move(scale)
    positions = rig.record(limit=200_000)
    units = positions / 100
    assert positions[-1] == scale * 100
    assert np.all(np.diff(positions) >= -noise(positions, 0))
    assert velocity(units).max() <= first["vel"] * 1.2 * (1 + 1e-3) + acc**2 / jrk / 2
    smooth = np.abs(jerk(units)) <= 2 * jrk * (1 + 1e-6) + noise(units, 3)
    assert smooth[:-4].mean() > 0.5 or len(units) < 20


@st.composite
def chains(draw: st.DrawFn) -> tuple[float, float, float, list[tuple[float, float]]]:
    """Feed, ACC, JRK and the speeds and lengths of merged moves, the last long enough to stop."""
    vel = draw(spread(1.0, 100.0))
    acc = vel / draw(spread(0.01, 0.5))
    jrk = acc / draw(spread(0.01, 0.5))
    stop = 1.3 * vel * (1.3 * vel / acc + acc / jrk)
    speeds = draw(st.lists(st.floats(0.2, 1.2), min_size=2, max_size=5))
    parts = [draw(spread(0.03, 3.0)) for _ in speeds[1:]] + [3.0]
    return vel, acc, jrk, [(v * vel, part * stop) for v, part in zip(speeds, parts, strict=True)]


@search(200)
@given(chains())
def test_merged_s_curves_keep_acceleration_and_jerk_at_every_junction(
    chain: tuple[float, float, float, list[tuple[float, float]]],
) -> None:
    """Speeds change from move to move, with STP 0 between them."""
    _, acc, jrk, moves = chain
    rig = Rig(ppu=[100.0])
    rig.depth(9)
    end = 0.0
    for number, (speed, length) in enumerate(moves):
        stp = acc if number + 1 == len(moves) else 0.0
        rig.master(acc=acc, dec=acc, stp=stp, jrk=jrk, vel=speed)
        end += length
        rig.move(end)
    units = rig.record(limit=300_000) / 100
    assert units[-1] == pytest.approx(end, rel=1e-12)
    assert np.abs(acceleration(units)).max() <= acc * (1 + 1e-3) + noise(units, 2)
    assert np.abs(jerk(units)).max() <= jrk * (1 + 1e-3) + noise(units, 3)


@pytest.mark.req("ACR-PROF-19")
def test_jerk_spares_the_motor() -> None:
    """The peak of the tracking error falls with JRK."""
    world = """
[[axis]]
number = 0
counts_per_rev = 4000
motor = { inertia_kgm2 = 2e-5, torque_nm_per_a = 0.5 }
drive = { mode = "torque", amps_per_volt = 0.01, peak_amps = 20.0 }
"""
    peaks = []
    for jrk in (0.0, 3e5):
        rig = Rig(world=world)
        rig.axis(proportional_gain=0.1, derivative_gain=3e-4)
        rig.master(acc=2e4, dec=2e4, stp=2e4, vel=2000, jrk=jrk)
        rig.ticks(100)
        rig.move(4000.0)
        rig.record()
        peaks.append(rig.real("peak_error_cnt"))
    assert peaks[1] < 0.8 * peaks[0]
