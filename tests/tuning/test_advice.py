"""What is said of a proposal: figures that are predicted worse than those of the present gains."""

from dataclasses import replace
from typing import Any, cast

import pytest

from openacr.tuning.advice import Advice, Outlook, worse
from openacr.tuning.frequency import Margins
from openacr.tuning.predict import StepFigures

PRESENT = StepFigures(20.0, 0.010, 0.050, None)
MARGINS = Margins(20.0, 50.0, 10.0, 200.0, 40.0, is_stable=True)  # 10 is 20 dB
Worse = dict[str, tuple[float | None, float | None]]


def outlook(figures: StepFigures, margins: Margins = MARGINS, error: float = 10.0) -> Outlook:
    return Outlook(cast(Any, None), margins, cast(Any, None), figures, None, error)


def advice(proposed: Outlook | None, present: Outlook | None = None) -> Advice:
    first = present or outlook(PRESENT)
    return Advice(cast(Any, None), cast(Any, None), first, None, proposed, "")


@pytest.mark.parametrize(
    ("proposed", "found"),
    [
        (None, {}),
        (PRESENT, {}),
        (StepFigures(21.0, 0.0105, 0.0525, None), {}),  # at the bounds
        (StepFigures(21.1, 0.009, 0.040, None), {"overshoot_percent": (20.0, 21.1)}),
        (StepFigures(2.0, 0.0106, 0.040, None), {"rise_s": (0.010, 0.0106)}),
        (StepFigures(2.0, 0.002, 0.0526, None), {"settling_s": (0.050, 0.0526)}),
        (StepFigures(2.0, 0.002, None, None), {"settling_s": (0.050, None)}),
    ],
)
def test_figures_of_a_step_that_are_worse_are_named_with_both_values(
    proposed: StepFigures | None, found: Worse
) -> None:
    assert worse(advice(None if proposed is None else outlook(proposed))) == found


def test_small_figures_are_worse_by_more_than_their_noise_only() -> None:
    present = outlook(StepFigures(0.0, 0.001, None, None))
    assert worse(advice(outlook(StepFigures(1.0, 0.0015, None, None)), present)) == {}
    assert worse(advice(outlook(StepFigures(1.1, 0.0016, None, None)), present)) == {
        "overshoot_percent": (0.0, 1.1), "rise_s": (0.001, 0.0016),
    }  # fmt: skip


@pytest.mark.parametrize(
    ("changed", "found"),
    [
        ({"phase_deg": 45.0}, {}),  # enough
        ({"phase_deg": 44.0}, {"phase_deg": (50.0, 44.0)}),
        ({"phase_deg": -60.0}, {"phase_deg": (50.0, -60.0)}),  # unstable
        ({"gain": 2.6}, {}),  # 8.3 dB
        ({"gain": 10.0 ** (7.0 / 20.0)}, {"gain_db": (20.0, 7.0)}),
        ({"gain": 10.0 ** (-7.0 / 20.0)}, {"gain_db": (20.0, 7.0)}),  # less gain makes it swing
        ({"bandwidth_hz": 38.0}, {}),  # at the bound
        ({"bandwidth_hz": 37.9}, {"bandwidth_hz": (40.0, 37.9)}),
        ({"bandwidth_hz": 90.0, "phase_deg": 70.0, "gain": 20.0}, {}),  # all are better
    ],
)
def test_margins_are_worse_where_they_have_become_less_than_enough(
    changed: dict[str, float], found: dict[str, tuple[float, float]]
) -> None:
    proposed = outlook(PRESENT, replace(MARGINS, **changed))  # type: ignore[arg-type]
    shown = worse(advice(proposed))
    assert shown.keys() == found.keys()
    assert [shown[name] for name in found] == [pytest.approx(each) for each in found.values()]


def test_a_margin_that_was_infinite_is_worse_without_a_number_before() -> None:
    present = outlook(PRESENT, replace(MARGINS, gain=float("inf")))
    proposed = outlook(PRESENT, replace(MARGINS, gain=2.0))
    before, after = worse(advice(proposed, present))["gain_db"]
    assert before is None
    assert after == pytest.approx(6.02, abs=0.01)


def test_the_error_of_the_sweep_is_worse_from_a_twentieth_on() -> None:
    assert worse(advice(outlook(PRESENT, error=10.5))) == {}
    assert worse(advice(outlook(PRESENT, error=10.6))) == {"rms_error_cnt": (10.0, 10.6)}
