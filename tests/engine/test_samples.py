"""Values recorded beside the axes: parameters of each kind and flags, tick by tick."""

import numpy as np
import pytest

from openacr.controller import Controller
from openacr.controller.trace import Reals
from openacr.engine.samples import SAMPLES, Sample, sample_of_flag, sample_of_parameter

MOVE = (
    'PROG0\rATTACH MASTER0\rATTACH SLAVE0 AXIS0 "X"\rPPU X1000\rPGAIN X0.002\rDRIVE ON X\r'
    "ACC 500\rDEC 500\rSTP 500\rVEL 20\rSYS\rDIM P(4)\rPROG0\rP2 = 0.1\rX1\rSET 63\r"
)
PARAMETERS = (12290, 12375, 2, 4097, 4100)  # LONG, FP32, FP64, words of outputs and of BIT128
FLAGS = (516, 63)  # In Motion; output 31, the sign bit of its word


def _samples(card: Controller) -> list[Sample]:
    found = [sample_of_parameter(card.memory, number) for number in PARAMETERS]
    return [one for one in found if one is not None] + [sample_of_flag(bit) for bit in FLAGS]


def _polled(ticks: int) -> Reals:
    """The same values read from outside after every tick."""
    card = Controller()
    card.send(MOVE)
    rows = []
    for _ in range(ticks):
        card.advance(1)
        values = [float(card.p[number]) for number in PARAMETERS]
        rows.append(values + [float(card.bit[bit]) for bit in FLAGS])
    return np.array(rows)


@pytest.mark.parametrize("rows_of_a_part", [65536, 8])
def test_every_value_is_that_of_its_tick(
    rows_of_a_part: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("openacr.controller.sample_buffers.CHUNK_ROWS", rows_of_a_part)
    card = Controller()
    card.send(MOVE)
    card.record(samples=_samples(card))
    card.advance(400)
    trace, polled = card.trace(), _polled(400)
    assert trace.values.tolist() == polled.tolist()
    assert np.ptp(polled[:, 0]) > 0 and np.ptp(polled[:, 5]) == 1  # it moves, and comes to rest
    assert polled[-1, 2] == 0.1
    assert polled[-1, 3] < 0 and polled[-1, 6] == 1  # output 31 is the sign of its word
    assert trace.axes[0].actual_u[-1] == 1.0  # the columns of the axes stay theirs


def test_rows_that_were_taken_are_not_given_again() -> None:
    card, whole = Controller(), Controller()
    for each in (card, whole):
        each.send(MOVE)
        each.record(3, samples=_samples(each))
    parts = []
    for ticks in (10, 1, 200):
        card.advance(ticks)
        parts.append(card.take_trace())
    whole.advance(211)
    assert card.take_trace().time_s.size == 0
    for name in ("time_s", "outputs", "values"):
        joined = np.concatenate([getattr(part, name) for part in parts])
        assert joined.tolist() == getattr(whole.trace(), name).tolist()


def test_recording_without_values_forgets_those_chosen_before() -> None:
    card = Controller()
    card.record(samples=[sample_of_flag(63)])
    card.record()
    card.advance(3)
    assert card.trace().values.shape == (3, 0)


def test_more_values_than_there_are_rows_for_are_refused() -> None:
    card = Controller()
    card.record(samples=[sample_of_flag(0)] * SAMPLES)
    with pytest.raises(ValueError, match="65 values cannot be recorded at once, at most 64"):
        card.record(samples=[sample_of_flag(0)] * (SAMPLES + 1))


def test_what_is_recorded_is_no_part_of_the_state() -> None:
    card, other = Controller(), Controller()
    for each in (card, other):
        each.send(MOVE)
    card.record(samples=[sample_of_flag(516)])
    for each in (card, other):
        each.advance(50)
    assert card.digest() == other.digest()


def test_a_number_the_card_does_not_have_gives_no_sample() -> None:
    assert sample_of_parameter(Controller().memory, 8000) is None
