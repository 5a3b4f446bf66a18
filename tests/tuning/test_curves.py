"""Records thinned out to curves, and the ends of frequency responses."""

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from openacr.tuning.advice import advice_data, advise
from openacr.tuning.curves import MOST_POINTS, curves
from openacr.tuning.excitation import Excitation
from openacr.tuning.measure import Measurement
from openacr.tuning.motor import Motor
from openacr.tuning.settings import LoopSettings
from openacr.tuning.twin import Record, run

T = 0.0005


def sine(count: int, period_tk: float, height: float) -> Record:
    angles = 2.0 * np.pi * np.arange(count) / period_tk
    values = height * np.sin(angles)
    return Record(T, values, np.roll(values, 3), 0.01 * np.cos(angles))


def test_a_record_that_is_short_is_drawn_sample_by_sample() -> None:
    record = sine(MOST_POINTS, 33.0, 100.0)
    (found,) = curves(record)
    assert found["actual_cnt"] == pytest.approx(record.actual_cnt.tolist(), rel=1e-5)
    assert found["time_s"] == pytest.approx((np.arange(MOST_POINTS) * T).tolist(), rel=1e-5)


@given(
    count=st.integers(MOST_POINTS + 1, 60_000),
    period_tk=st.floats(12.0, 4000.0),
    second=st.floats(0.5, 2.0),
)
def test_a_long_record_keeps_its_ends_and_the_peaks_of_all_its_parts(
    count: int, period_tk: float, second: float
) -> None:
    records = [sine(count, period_tk, 100.0), sine(count, period_tk / second, 50.0)]
    found = curves(*records)
    assert found[0]["time_s"] == found[1]["time_s"]
    times = np.array(found[0]["time_s"])
    assert len(times) <= MOST_POINTS
    assert times[0] == 0.0
    assert times[-1] == pytest.approx((count - 1) * T, rel=1e-5)
    part_s = count * T / 20.0
    for record, curve in zip(records, found, strict=True):
        for k in range(20):
            part = slice(round(k * count / 20), round((k + 1) * count / 20))
            inside = (times >= (k - 0.1) * part_s) & (times <= (k + 1.1) * part_s)
            for name in ("setpoint_cnt", "actual_cnt", "output_v"):
                whole, drawn = getattr(record, name)[part], np.array(curve[name])[inside]
                assert drawn.max() >= whole.max() - 1e-3
                assert drawn.min() <= whole.min() + 1e-3


def test_open_loops_are_drawn_up_to_where_they_still_have_a_phase() -> None:
    settings, motor = LoopSettings.of_gains(T, pgain=0.006, dgain=7e-5), Motor(3.27e6, 5.0)
    excitation = Excitation(duration_s=1.5).checked()
    t = np.arange(3600) * T
    swept = 100.0 * np.sin(2.0 * np.pi * (2.0 * t + 58.0 * t * t / 3.0)) * (t < 1.5)
    found = advise(Measurement(0, excitation, settings, run(settings, motor, swept)))
    data = json.loads(json.dumps(advice_data(found)))
    bode = data["bode"]
    frequencies = np.array(bode["frequency_hz"])
    assert (frequencies[0], frequencies[-1]) == pytest.approx((1.0, 0.45 / T))
    for name in ("motor", "present", "proposed"):
        assert np.abs(np.diff(bode[name]["phase_deg"])).max() < 10.0
        assert np.abs(np.diff(bode[name]["magnitude_db"])).max() < 5.0
    assert data["measured"]["time_s"] == data["modelled"]["time_s"]
    assert data["measured_to_hz"] == pytest.approx(60.0, rel=0.02)
