"""Recording: at a fixed interval of ticks, or sparsely with the peaks between the samples kept."""

import numpy as np
import pytest

from openacr.controller import Controller
from openacr.controller.trace import Trace

MOVE = (
    'PROG0\rATTACH MASTER0\rATTACH SLAVE0 AXIS0 "X"\rATTACH SLAVE1 AXIS1 "Y"\rPPU X1000 Y500\r'
    "PGAIN X0.002 Y0.002\rDRIVE ON X Y\rACC 500\rDEC 500\rSTP 500\rVEL 20\rX1 Y-2\rX-1 Y0\r"
)


def recorded(every_tk: int, *, keep_peaks: bool = False) -> Trace:
    card = Controller()
    card.send(MOVE)
    card.record(every_tk, keep_peaks=keep_peaks)
    card.advance(1003)
    return card.trace()


@pytest.mark.parametrize("rows_of_a_part", [65536, 8])
def test_peaks_between_two_samples_are_kept(
    rows_of_a_part: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("openacr.controller.sample_buffers.CHUNK_ROWS", rows_of_a_part)
    full, sparse = recorded(1), recorded(10, keep_peaks=True)
    assert sparse.time_s.size == 102
    for axis, thin in zip(full.axes[:2], sparse.axes, strict=False):
        for all_values, kept in (
            (axis.velocity_ups, thin.velocity_ups),
            (axis.following_error_u, thin.following_error_u),
        ):
            assert np.ptp(all_values) > 0.0
            for first in range(0, 1000, 20):
                part = all_values[first : first + 20]
                low, high = kept[first // 10 : first // 10 + 2]
                assert (low, high) == (part.min(), part.max())


def test_times_and_positions_stay_those_of_one_tick() -> None:
    full, sparse = recorded(1), recorded(10, keep_peaks=True)
    at = np.searchsorted(full.time_s, sparse.time_s - 1e-9)[:100]
    assert at.tolist() == list(range(0, 1000, 10))
    for axis, thin in zip(full.axes, sparse.axes, strict=True):
        assert thin.commanded_u[:100].tolist() == axis.commanded_u[at].tolist()
        assert thin.actual_u[:100].tolist() == axis.actual_u[at].tolist()


def test_without_peaks_every_column_is_that_of_its_tick() -> None:
    full, thin = recorded(1), recorded(7)
    assert thin.time_s.tolist() == full.time_s[::7].tolist()
    for one, other in zip(full.axes, thin.axes, strict=True):
        assert other.following_error_u.tolist() == one.following_error_u[::7].tolist()
        assert other.velocity_ups.tolist() == one.velocity_ups[::7].tolist()
    assert full.axes[0].following_error_u == pytest.approx(
        full.axes[0].commanded_u - full.axes[0].actual_u
    )
