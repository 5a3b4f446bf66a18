"""The forecast of many moves at once: the same times and findings as move by move."""

import random
from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.cnc import test_many_holes
from tests.cnc.programs import made, unrolled
from tests.cnc.test_many_blocks import program
from tests.search import search

from openacr.cnc.canonical import Entry, Moves
from openacr.cnc.interpreter.interpreter import Options
from openacr.cnc.reading.findings import BlockError, Finding
from openacr.compiled import is_compiled
from openacr.mill.config.settings import Settings
from openacr.mill.plan.estimate import forecast, forecast_cy
from openacr.mill.plan.estimate.forecast import Forecast
from openacr.mill.plan.estimate.predicting import Prediction, Predictor
from openacr.mill.plan.estimate.preflight import Preflight
from openacr.sysvar.tabs import AXIS, CONTROL, SPEEDS

BEGIN = (0.0,) * 8
HOMED = 271


def machine(chance: random.Random) -> dict[int, float]:
    """Settings that act on moves and corners, each now and then."""
    cells = {HOMED: float(chance.choice([0, 1, 3, 127, 127]))}
    may = [
        (SPEEDS.corner_step, 0.4),
        (CONTROL.acute_angle1_threshold, 20.0),
        (CONTROL.acute_angle2, 120.0),
        (SPEEDS.max_rotary_speed, 300.0),
        (CONTROL.forward_threshold, 40.0),
        (AXIS.max_axis_speed[1], 25.0),
        (AXIS.max_axis_acceleration[0], 2.5),
        (AXIS.max_axis_acceleration[3], 90.0),
        (AXIS.tolerance_radius[3], 4.0),
        (AXIS.pulses_per_unit[2], 12345.0),
        (AXIS.pulses_per_unit[0], 3e9),
    ]
    cells |= {n: value for n, value in may if chance.random() < 0.25}
    for axis in range(4):
        if chance.random() < 0.3:
            cells |= {
                AXIS.disable_limit[axis]: 0.0,
                AXIS.plus_soft_limit[axis]: chance.choice([1.0, 2.5, 30.0]),
                AXIS.minus_soft_limit[axis]: -2.0,
            }
    return cells


def entries_of(text: str, cells: dict[int, float], dialect: str) -> tuple[list[Entry], Settings]:
    done = made(text, cells, axes=7, dialect=dialect, options=Options(has_batches=True))
    settings = Settings(done.cells)
    found: list[Entry] = []
    if not done.interpreter.program.errors:
        try:
            for entry in done.interpreter.entries():
                found.append(entry)
                if len(found) > 2000:
                    break
        except BlockError:
            pass
    return found, settings


def at_once(
    entries: list[Entry], settings: Settings, *, is_dry: bool, rounds: bool
) -> tuple[Prediction, list[Finding]]:
    desk = Preflight(settings)
    made = Forecast(settings, BEGIN, is_dry=is_dry, rounds=rounds, desk=desk)
    for entry in entries:
        made.add(entry)
    made.close()
    return made.found, desk.findings(lambda source: f"{source.file} {source.line}")


def one_by_one(
    entries: list[Entry], settings: Settings, *, is_dry: bool, rounds: bool
) -> tuple[Prediction, list[Finding]]:
    desk = Preflight(settings)
    made = Predictor(settings, BEGIN, is_dry=is_dry, rounds=rounds, reader=desk)
    for entry in unrolled(iter(entries)):
        made.add(entry)
    made.close()
    return made.found, desk.findings(lambda source: f"{source.file} {source.line}")


def require_same(seed: int, write: Callable[[random.Random, str], str] = program) -> list[Entry]:
    chance = random.Random(seed)
    dialect = chance.choice(["acromill", "rs274ngc"])
    lines = write(chance, dialect).splitlines()
    if chance.random() < 0.5:
        lines.insert(0, "G64 P.02" if dialect == "rs274ngc" else "G62")
    if chance.random() < 0.5:
        point = [0.0, 0.0]
        for _ in range(chance.choice([20, 700])):
            point = [x + chance.uniform(-0.01, 0.01) for x in point]
            lines.insert(2, f"G1 X{point[0]:.4f} Y{point[1]:.4f}")
    entries, settings = entries_of("\n".join(lines), machine(chance), dialect)
    is_dry, rounds = chance.random() < 0.2, chance.random() < 0.8
    (time, found), (other, expected) = (
        each(entries, settings, is_dry=is_dry, rounds=rounds) for each in (at_once, one_by_one)
    )
    assert time.moves == other.moves
    assert (time.rapid_s, time.feed_s, time.dwell_s) == pytest.approx(
        (other.rapid_s, other.feed_s, other.dwell_s), rel=1e-9
    )
    assert found == expected
    return entries


@search(30)
@given(seed=st.integers(0, 10**9))
def test_holes_have_the_same_times_and_findings_at_their_lines(seed: int) -> None:
    require_same(seed, test_many_holes.program)


@search(120)
@given(seed=st.integers(0, 10**9))
def test_the_forecast_is_that_of_the_moves_one_by_one(seed: int) -> None:
    require_same(seed)


def test_batches_are_forecast() -> None:
    assert any(isinstance(entry, Moves) for seed in range(40) for entry in require_same(seed))


def test_very_short_moves_wait_for_four_thousand_others_at_most() -> None:
    text = "G64\nG1 F9000\n" + "".join(f"G1 X{k * 1e-5:.5f}\n" for k in range(1, 9000)) + "M2"
    entries, settings = entries_of(text, {HOMED: 127.0}, "rs274ngc")
    (time, found), (other, expected) = (
        each(entries, settings, is_dry=False, rounds=True) for each in (at_once, one_by_one)
    )
    assert (time.moves, found) == (other.moves, expected)
    assert time.feed_s == pytest.approx(other.feed_s, rel=1e-12)


def test_both_builds_forecast_alike(monkeypatch: pytest.MonkeyPatch) -> None:
    if not is_compiled:
        pytest.skip("only plain Python here")
    chance = random.Random(4)
    for _ in range(12):
        entries, settings = entries_of(program(chance, "rs274ngc"), machine(chance), "rs274ngc")
        compiled = at_once(entries, settings, is_dry=False, rounds=True)
        for name in ("moves", "add", "release", "close"):
            monkeypatch.setattr(forecast, f"_{name}", getattr(forecast_cy, f"forecast_{name}"))
        assert at_once(entries, settings, is_dry=False, rounds=True) == compiled
        monkeypatch.undo()


@pytest.mark.parametrize("unit", ["G20", "G21"])
def test_turns_count_as_corner_steps_in_both(unit: str) -> None:
    turns = [f"G1 X{k / 10} Y{k % 3 / 30} A{4 * (k % 2)} C{k % 3}" for k in range(1, 40)]
    text = "\n".join([unit, "G91.1 F900", *turns, "G3 X1 Y1 I1 J0 A9", "G1 X2 A0", "M2"])
    times = []
    for step in (0.0, 0.4):
        cells = {AXIS.home_required[axis]: 0.0 for axis in range(7)}
        entries, found = entries_of(text, cells | {SPEEDS.corner_step: step}, "rs274ngc")
        assert entries
        times += [
            each(entries, found, is_dry=False, rounds=True)[0].feed_s
            for each in (at_once, one_by_one)
        ]
    assert times[0] == pytest.approx(times[1], rel=1e-12)
    assert times[2] == pytest.approx(times[3], rel=1e-12)
    assert times[2] > 1.01 * times[0]
