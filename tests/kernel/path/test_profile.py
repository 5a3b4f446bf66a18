"""Coordinated moves without jerk: ends to the count, limits kept, times as in the closed form.

Which limit applies when: the path speed never exceeds VEL (times the override); its change
never exceeds the ramp in force, ACC upwards, DEC to a slower cruise, STP at the end. Only
where a path enters a move faster than STP can stop it within that move, braking is harder:
then at exactly the one rate that still arrives.
"""

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from tests.kernel import oracle
from tests.kernel.rig import Reals, Rig, T, acceleration, jerk, noise, velocity
from tests.search import search

from openacr.motion.path import moves

pytestmark = pytest.mark.evidence("oracle", "closed forms of the profiles")

settings.register_profile("kernel", deadline=None, derandomize=True, database=None)
settings.load_profile("kernel")


def spread(low: float, high: float) -> st.SearchStrategy[float]:
    """Numbers spread evenly over decades."""
    return st.floats(math.log10(low), math.log10(high)).map(lambda x: 10.0**x)


@st.composite
def shapes(draw: st.DrawFn) -> dict[str, float]:
    """Length, speed and rates of a move that lasts between a tick and a few seconds."""
    length = draw(spread(1e-4, 1e4))
    vel = length / draw(spread(1e-3, 1.0))
    rates = st.one_of(st.just(0.0), spread(1e-3, 0.5).map(lambda s: vel / s))
    shape = {"length": length, "vel": vel, "acc": draw(rates), "dec": draw(rates)}
    shape["stp"] = vel / draw(spread(1e-3, 0.5))
    shape["fvel"] = draw(st.one_of(st.just(0.0), st.floats(0.0, 1.5).map(lambda r: r * vel)))
    shape["ivel"] = draw(st.one_of(st.just(0.0), st.floats(0.0, 1.5).map(lambda r: r * vel)))
    return shape


def set_up(shape: dict[str, float], rig: Rig) -> dict[str, float]:
    """Give a rig the profile of a shape; values as the card holds them."""
    for name in ("vel", "acc", "dec", "stp", "jrk", "fvel", "ivel"):
        rig.master(**{name: shape.get(name, 0.0)})
    return shape | {"vel": float(np.float32(shape["vel"]))}


def ticks_moved(positions: Reals) -> int:
    """Number of the tick in which In Motion went off, of a record with one tick more."""
    return len(positions) - 2


@search(600)
@given(shapes(), st.sampled_from([1.0, -1.0]), st.sampled_from([1.0, 0.01, 1000.0, -8000.0]))
def test_a_move_ends_on_its_target_within_limits_and_in_time(
    shape: dict[str, float], sign: float, ppu: float
) -> None:
    rig = Rig(ppu=[ppu])
    shape = set_up(shape, rig)
    target = sign * shape["length"]
    rig.move(target)
    positions = rig.record()
    scale = float(np.float32(ppu))

    assert positions[-1] == positions[-2] == target * scale
    assert rig.long("current_position") == round(target * scale)
    assert np.all(np.isfinite(positions))
    assert np.all(np.diff(positions) * math.copysign(1.0, target * scale) >= 0)
    units = np.abs(positions / scale)
    assert velocity(units).max() <= shape["vel"] * (1 + 1e-6) + noise(units, 1)

    entry = min(shape["ivel"], shape["vel"])
    leg = oracle.move(
        shape["length"], shape["vel"], shape["acc"], shape["dec"], shape["stp"],
        entry=entry, fvel=shape["fvel"],
    )  # fmt: skip
    assert abs(ticks_moved(positions) - leg.time / T) <= 1 + 1e-6 * leg.time / T
    rates = [r for r in (shape["acc"], shape["stp"]) if r]
    if leg.forced:
        rates.append((entry**2 - shape["fvel"] ** 2) / (2 * shape["length"]))
    inner = np.abs(acceleration(units))[2:-2]  # without the steps of IVEL, FVEL and ACC 0
    if shape["acc"] and inner.size:
        stops_within = leg.end == 0
        bound = max(rates) * (1 + 1e-6) + noise(units, 2)
        tail = inner if stops_within else inner[:-1]
        assert tail.max(initial=0.0) <= bound


def test_published_profiles_take_their_times() -> None:
    for settings_, length, seconds, peak in (
        ({"acc": 10, "stp": 10, "vel": 20}, 200, 12.0, 20.0),
        ({"acc": 100, "stp": 100, "vel": 50}, 10, 0.632456, 31.6228),
        ({"acc": 100, "stp": 100, "vel": 50, "jrk": 1000}, 40, 1.4, 50.0),
        ({"acc": 100, "stp": 100, "vel": 50, "jrk": 1000}, 5, 0.558258, 17.9129),
        ({"acc": 100, "stp": 100, "vel": 20, "fvel": 5}, 10, 0.65625, 20.0),
        ({"acc": 100, "stp": 0, "vel": 20}, 10, 0.6, 20.0),
    ):
        rig = Rig(ppu=[1000.0]).master(**{k: float(v) for k, v in settings_.items()})
        rig.move(float(length))
        positions = rig.record()
        assert ticks_moved(positions) * T == pytest.approx(seconds, abs=T * 1.001)
        assert velocity(positions).max() / 1000 == pytest.approx(peak, rel=2e-3)


@search(150)
@given(st.lists(shapes(), min_size=2, max_size=3), st.lists(st.booleans(), min_size=3, max_size=3))
def test_merged_moves_pass_on_their_speed_and_end_exactly(
    chain: list[dict[str, float]], stops: list[bool]
) -> None:
    rig = Rig(ppu=[100.0])
    rig.depth(9)
    expected, entry, biggest, position = 0.0, 0.0, 0.0, 0.0
    lengths = []
    for shape, stop in zip(chain, stops, strict=False):
        shape = dict(shape, vel=chain[0]["vel"] * shape["vel"] / shape["length"])
        shape["vel"] = chain[0]["vel"] * (0.2 + (shape["fvel"] / (shape["vel"] or 1)) % 1.0)
        shape["length"] = chain[0]["length"] * (0.3 + shape["ivel"] / (shape["vel"] + 1) % 1.0)
        acc = shape["acc"] = chain[0]["stp"]
        dec = shape["dec"] = chain[0]["stp"] / 2
        shape["stp"] = chain[0]["stp"] * 2 if stop else 0.0
        shape["fvel"] = shape["ivel"] = 0.0
        shape = set_up(shape, rig)
        position += shape["length"]
        rig.move(position)
        lengths.append(shape["length"])
        leg = oracle.move(shape["length"], shape["vel"], acc, dec, shape["stp"], entry=entry)
        expected += leg.time
        biggest = max(biggest, shape["vel"], entry)
        entry = leg.end
    positions = rig.record(limit=200_000)
    assert positions[-1] == position * 100.0
    assert np.all(np.diff(positions) >= 0)
    assert velocity(positions).max() / 100 <= biggest * (1 + 1e-6) + noise(positions, 1)
    assert abs(ticks_moved(positions) - expected / T) <= 1 + 1e-5 * expected / T


@search(200)
@given(shapes(), st.data())
@example(
    {"length": 10.0, "vel": 50.0, "acc": 100.0, "dec": 50.0, "stp": 100.0, "fvel": 20.0, "ivel": 0},
    None,
)
def test_overrides_holds_and_starts_at_any_tick_keep_the_end_and_the_limits(
    shape: dict[str, float], data: st.DataObject | None
) -> None:
    rig = Rig(ppu=[1000.0])
    shape = set_up(shape | {"ivel": 0.0, "fvel": 0.0}, rig)
    for rate in ("acc", "dec"):
        shape[rate] = shape[rate] or shape["stp"]
    set_up(shape, rig)
    history = disturbed(rig, shape, data)
    assert history[-1] == shape["length"] * 1000
    history = history / 1000
    assert np.all(np.diff(history) >= 0)
    assert velocity(history).max() <= 2.0 * shape["vel"] * (1 + 1e-6) + noise(history, 1)
    bound = max(shape[r] for r in ("acc", "dec", "stp"))
    assert np.abs(acceleration(history)).max() <= bound * (1 + 1e-6) + noise(history, 2)


def disturbed(rig: Rig, shape: dict[str, float], data: st.DataObject | None) -> Reals:
    """Positions of a move during which overrides and holds come and go."""
    rig.move(shape["length"])
    leg = oracle.move(
        shape["length"], shape["vel"], shape["acc"], shape["dec"], shape["stp"],
        jerk=shape.get("jrk", 0.0),
    )  # fmt: skip
    span = max(int(leg.time / T), 2)
    events = [(span // 3, "fov", 0.3), (span // 2, "hold", 0.0), (9, "go", 0.0), (2, "fov", 2.0)]
    if data is not None:
        events = data.draw(
            st.lists(
                st.tuples(
                    st.integers(1, span),
                    st.sampled_from(["fov", "fov", "hold", "go"]),
                    st.sampled_from([0.0, 0.1, 0.5, 1.0, 2.0]),
                ),
                max_size=6,
            )
        )
    positions = [0.0]
    for wait, what, value in [*events, (1, "fov", 1.0), (0, "go", 0.0)]:
        for _ in range(wait):
            positions.append(rig.ticks().real("psp_cnt"))
        if what == "fov":
            rig.master(fov=value)
        elif what == "hold":
            moves.hold(rig.card, 0)
        else:
            moves.release(rig.card, 0)
    return np.array([*positions[:-1], *rig.record(limit=400_000)])


END_RAMP = 514


@pytest.mark.parametrize("jrk", [0.0, 1000.0])
@pytest.mark.parametrize("fov", [0.1, 0.5, 0.95, 2.0])
def test_an_override_changed_in_the_end_ramp_acts_and_the_end_stays_exact(
    jrk: float, fov: float
) -> None:
    """A lower feed is reached with DEC, a higher one as far as the distance left allows."""
    times = []
    for override in (1.0, fov):
        rig = Rig(ppu=[1000.0]).master(acc=100, dec=200, stp=100, jrk=jrk, vel=20)
        rig.move(10.0)
        positions = [0.0]
        while not rig.bit(END_RAMP) or rig.path_velocity > 12.0:
            positions.append(rig.ticks().real("psp_cnt"))
        rig.master(fov=override)
        rest = rig.record()
        units = np.array([*positions, *rest[1:]]) / 1000
        assert units[-1] == 10.0
        assert np.all(np.diff(units) >= -noise(units, 0))
        assert np.abs(acceleration(units)).max() <= 200 * (1 + 1e-6)
        if jrk:
            assert np.abs(jerk(units)).max() <= jrk * (1 + 1e-5) + noise(units, 3)
        times.append(len(units))
        if override < 0.5:
            late = velocity(units[-40:])
            assert late.max() <= 20 * override * (1 + 1e-9)
    if fov < 0.2 or (fov < 0.6 and not jrk):
        assert times[1] > times[0]
    elif not jrk:
        assert times[1] == pytest.approx(times[0], abs=1)


def test_a_hold_in_a_soft_end_ramp_comes_to_rest_before_the_target() -> None:
    rig = Rig(ppu=[1000.0]).master(acc=100, dec=400, stp=50, vel=20)
    rig.move(10.0)
    positions = [0.0]
    while not rig.bit(END_RAMP):
        positions.append(rig.ticks().real("psp_cnt"))
    moves.hold(rig.card, 0)
    for _ in range(400):
        positions.append(rig.ticks().real("psp_cnt"))
    assert rig.bit(519)
    rested = positions[-1] / 1000
    assert rested == pytest.approx(10.0 - 20.0**2 / 100 + 20.0**2 / 800, abs=0.02)
    moves.release(rig.card, 0)
    units = np.array([*positions, *rig.record()[1:]]) / 1000
    assert units[-1] == 10.0
    assert np.abs(acceleration(units)).max() <= 400 * (1 + 1e-6)
