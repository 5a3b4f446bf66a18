"""What is said of a proposal: a predicted step that is worse than the present one."""

from typing import Any, cast

import pytest

from openacr.tuning.advice import Advice, Outlook, worse
from openacr.tuning.predict import StepFigures

PRESENT = StepFigures(20.0, 0.010, 0.050, None)


def advice(proposed: StepFigures | None, present: StepFigures = PRESENT) -> Advice:
    def outlook(figures: StepFigures) -> Outlook:
        return Outlook(cast(Any, None), cast(Any, None), cast(Any, None), figures, None)

    after = None if proposed is None else outlook(proposed)
    return Advice(cast(Any, None), cast(Any, None), outlook(present), None, after, "")


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
    proposed: StepFigures | None, found: dict[str, tuple[float, float | None]]
) -> None:
    assert worse(advice(proposed)) == found


def test_small_figures_are_worse_by_more_than_their_noise_only() -> None:
    present = StepFigures(0.0, 0.001, None, None)
    assert worse(advice(StepFigures(1.0, 0.0015, None, None), present)) == {}
    assert worse(advice(StepFigures(1.1, 0.0016, None, None), present)) == {
        "overshoot_percent": (0.0, 1.1), "rise_s": (0.001, 0.0016),
    }  # fmt: skip
