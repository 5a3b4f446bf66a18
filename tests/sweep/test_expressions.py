"""Measures: what they compute, and what is refused with its reason."""

import math

import numpy as np
import pytest

from openacr.errors import UserError
from openacr.sweep.expressions import Measure, Needs, Series, Value


class Recording:
    """Five rows, 0.1 s apart."""

    time_s = np.array([0.1, 0.2, 0.3, 0.4, 0.5])
    end_s = 0.5
    period_s = 0.1

    def axis(self, number: int, name: str) -> Value:
        if name == "peak_velocity":
            return 7.5
        return np.array([0.0, -3.0, 2.0, 0.5, -0.25]) + number

    def series(self, name: str) -> Series:
        return np.array([0.0, 1.0, 1.0, 0.0, 1.0]) if name == "BIT516" else np.arange(5.0)

    def present(self, name: str) -> float:
        return {"P12290": 4.5, "BIT516": 1.0, "AXIS1.actual": -8.0}[name]


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("2 + 3 * gain ** 2", 14.0),
        ("-gain / 4", -0.5),
        ("+gain - 1", 1.0),
        ("max(AXIS0.following_error)", 2.0),
        ("min(AXIS0.following_error)", -3.0),
        ("max(abs(AXIS0.following_error))", 3.0),
        ("max(abs(AXIS1.following_error))", 3.0),
        ("max(1, gain, 1.5)", 2.0),
        ("min(1, gain)", 1.0),
        ("mean(P100)", 2.0),
        ("rms(P100)", math.sqrt(6.0)),
        ("sqrt(16)", 4.0),
        ("exp(0) + log(1) + sin(0) + cos(0)", 2.0),
        ("AXIS3.peak_velocity", 7.5),
        ("at_end(P12290) + at_end(BIT516)", 5.5),
        ("at_end(AXIS1.actual)", -8.0),
        ("end_time", 0.5),
        ("max(time)", 0.5),
        ("ever(BIT516)", 1.0),
        ("ever(P100 > 4)", 0.0),
        ("ever(P100 >= 4)", 1.0),
        ("ever(P100 < 0)", 0.0),
        ("ever(P100 <= 0)", 1.0),
        ("first_time(BIT516)", 0.2),
        ("last_time(P100 == 3)", 0.4),
        ("first_time(P100 != 0)", 0.2),
        ("duration(BIT516)", 0.3),
        ("duration(BIT516 and P100 > 1)", 0.2),
        ("duration(BIT516 or P100 > 2)", 0.4),
        ("duration(not BIT516)", 0.2),
        ("integral(P100)", 1.0),
        ("settling_time(AXIS0.following_error, 0.5)", 0.4),
        ("settling_time(AXIS0.following_error, 0.5, 0.1)", 0.3),
        ("settling_time(AXIS0.following_error, 3)", 0.0),
        ("settling_time(AXIS0.following_error, 0.5, 0.35)", 0.0),
        ("settling_time(AXIS0.following_error, 0.2)", math.nan),
        ("first_time(P100 > 9)", math.nan),
        ("last_time(P100 > 9)", math.nan),
        ("1 / 0", math.inf),
        ("0 / 0", math.nan),
        ("(gain > 1) + (gain > 3)", 1.0),
    ],
)  # fmt: skip
def test_a_measure_is_one_number(text: str, value: float) -> None:
    found = Measure(text, frozenset({"gain"}), Needs()).value(Recording(), {"gain": 2.0})
    assert found == pytest.approx(value, abs=1e-12, nan_ok=True)


def test_a_measure_says_what_is_to_be_recorded() -> None:
    needs = Needs()
    Measure("AXIS3.distance + at_end(P7) + at_end(AXIS5.actual)", frozenset(), needs)
    assert (needs.axes, needs.samples, needs.ends) == ({3, 5}, set(), {"P7"})
    assert not needs.has_series
    Measure("max(P12290) + ever(BIT516)", frozenset(), needs)
    assert needs.samples == {"P12290", "BIT516"}
    assert needs.has_series


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("", "'' is not an expression that can be read"),
        ("max(", "'max(' is not an expression that can be read"),
        ("1e400 * " + "9" * 400, "is not an expression that can be read"),
        ("+".join("1" * 5000), "is not an expression that can be read"),
        ("P12290", "'P12290' is a value for each tick; a measure is one number"),
        ("abs(AXIS0.velocity)", "is a value for each tick; a measure is one number"),
        ("gian", "there is no 'gian'; known are time, end_time, AXIS0.following_error"),
        ("AXIS0", "AXIS0 alone is no value; write AXIS0.following_error"),
        ("AXIS0.speed", "an axis has no 'speed'; it has commanded, actual, velocity"),
        ("P0.actual", "there is no 'P0.actual'"),
        ("median(P0)", "there is no function 'median'; known are abs, sqrt"),
        ("mean(3)", "mean needs a value for each tick, such as AXIS0.velocity"),
        ("mean(P0, P1)", "mean takes 1 values"),
        ("settling_time(P0)", "settling_time takes 2 or 3 values"),
        ("settling_time(P0, P1)", "settling_time: only its first value may be one for each tick"),
        ("max(P0, 3)", "max of several values takes numbers only"),
        ("at_end(3)", "at_end takes a parameter, a flag, or a value of an axis"),
        ("at_end(AXIS0.distance)", "at_end takes a parameter, a flag, or a value of an axis"),
        ("at_end(P0, P1)", "at_end takes a parameter, a flag, or a value of an axis"),
        ("'a'", "cannot be part of a measure"),
        ("True", "cannot be part of a measure"),
        ("1 < 2 < 3", "cannot be part of a measure"),
        ("[1]", "cannot be part of a measure"),
        ("(1).real", "there is no '1 .real'"),
        ("__import__('os')", "there is no function '__import__'"),
        ("1 if 2 else 3", "cannot be part of a measure"),
        ("5 % 2", "cannot be part of a measure"),
    ],
)
def test_what_is_no_measure_is_refused_with_the_reason(text: str, why: str) -> None:
    with pytest.raises(UserError) as error:
        Measure(text, frozenset({"gain"}), Needs())
    assert why in str(error.value)
