"""The computed axis does what a card does, sample by sample."""

import numpy as np
import pytest
from tests.tuning import worlds
from tests.tuning.worlds import AXIS, true_motor

import openacr
from openacr.map.rows import axes
from openacr.plant.describe.load import parse_world
from openacr.tuning.motor import Motor
from openacr.tuning.settings import ROWS, LoopSettings
from openacr.tuning.twin import Record, run

PERIOD_S = 0.0005
WORLD = worlds.WORLD + "offset_v = 0.01\n"
BIQUAD = 786 + 32 * AXIS


def recorded(
    lines: str, setpoint_cnt: np.ndarray, world: str = WORLD
) -> tuple[LoopSettings, Record]:
    """What a card does with axis 1 after these lines, and its settings."""
    card = openacr.Controller(world=parse_world(world))
    card.send('PROG0\rATTACH MASTER0\rATTACH SLAVE0 AXIS1 "X"\rMULT X4\r' + lines + "\r")
    rows = {row: card.p[row[AXIS]] for row in ROWS}
    settings = LoopSettings(rows, bool(card.bit[BIQUAD]), card.period_s)
    seen = []
    for jog in setpoint_cnt:
        card.p[axes.jog_offset[AXIS]] = int(jog)
        card.advance(1)
        seen.append([card.p[row[AXIS]] for row in (axes.actual_position, axes.output_signal)])
    actual, output = np.array(seen).T
    return settings, Record(card.period_s, setpoint_cnt, actual, output)


@pytest.mark.parametrize(
    "lines",
    [
        "PGAIN X0.005 DGAIN X0.00005 IGAIN X0.04 ILIMIT X0.4",
        "PGAIN X0.005 DGAIN X0.00005 DWIDTH X0.0015 TLM X1.5",
        "PGAIN X0.004 DGAIN X0.00005 FFVEL X0.0000015 FFACC X0.00000001 FFVC X5000",
        "PGAIN X0.003 P12658=2 DGAIN X0.00004 LOPASS X300 NOTCH X(150,40)",
    ],
)
def test_the_computed_step_is_that_of_the_card_to_the_count(lines: str) -> None:
    setpoint = np.concatenate((np.zeros(3), np.full(300, 200.0), np.full(300, -31.0)))
    settings, card = recorded(lines.replace(" P12658", "\rP12658").replace("=2 ", "=2\r"), setpoint)
    computed = run(settings, true_motor(WORLD), setpoint)
    assert np.ptp(card.actual_cnt) > 150
    assert np.array_equal(computed.actual_cnt, card.actual_cnt)
    assert np.array_equal(computed.output_v, card.output_v)


def test_a_delay_is_what_the_drive_adds_to_the_period_of_the_loop() -> None:
    settings = LoopSettings.of_gains(PERIOD_S, pgain=0.005, limit_v=1.0)
    setpoint = np.concatenate((np.zeros(2), np.full(6, 1000.0)))
    moved = {
        delay: run(settings, Motor(1e9, delay_tk=delay), setpoint).actual_cnt.tolist()
        for delay in (0.0, 1.0, 1.5)
    }
    # at 1 V: 1e9 / 2 * (k T)^2 = 125 k^2 counts; half a volt in the first period
    # is 1638 steps of the converter: 62.5 - 0.015 more, from the middle of a count
    assert moved[0.0][:6] == [0, 0, 0, 125, 500, 1125]
    assert moved[1.0][:6] == [0, 0, 0, 0, 125, 500]
    assert moved[1.5][:7] == [0, 0, 0, 0, 62, 312, 812]


def test_a_record_knows_its_error_and_its_times() -> None:
    record = Record(0.001, np.array([3.0, 5.0]), np.array([1.0, 6.0]), np.zeros(2))
    assert record.error_cnt.tolist() == [2.0, -1.0]
    assert record.times_s.tolist() == [0.0, 0.001]


def test_an_axis_begins_where_a_record_does_with_its_integral() -> None:
    gains = {"pgain": 0.01, "dgain": 1e-4, "ffvel": 1e-3, "ffacc": 1e-5}
    held = Motor(1e6, coulomb_accel=1e6)
    first = Record(PERIOD_S, np.zeros(4), np.full(4, -8.0), np.full(4, 0.3))
    with_integral = LoopSettings.of_gains(PERIOD_S, **gains, igain=0.5, ilimit=2.0)
    for settings, output_v in (
        (LoopSettings.of_gains(PERIOD_S, **gains), 0.08),  # PGAIN, and no kick by its place
        (with_integral, 0.3 + 0.5 * 8 * PERIOD_S),  # and the integral of one period
    ):
        found = run(settings, held, np.zeros(4), first)
        assert found.actual_cnt.tolist() == [-8.0] * 4
        assert found.setpoint_cnt.tolist() == [0.0] * 4
        assert found.output_v[0] == pytest.approx(output_v, rel=1e-6)
