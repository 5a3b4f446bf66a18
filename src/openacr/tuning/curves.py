"""Records as curves of a bounded length, for pictures: their peaks are kept."""

import numpy as np
from numpy.typing import NDArray

from openacr.tuning.motor import Reals
from openacr.tuning.twin import Record

MOST_POINTS = 4000
_VALUES = ("setpoint_cnt", "actual_cnt", "output_v")


def curves(*records: Record) -> list[dict[str, list[float]]]:
    """Records of the same length as curves with the same times.

    A long one is thinned out: of each group of samples those remain at which a curve is lowest
    and highest. Every nth sample of a sine would show another one.
    """
    kept = _kept([getattr(each, name) for each in records for name in _VALUES])
    return [
        {
            "time_s": rounded(record.times_s[kept]),
            **{name: rounded(getattr(record, name)[kept]) for name in _VALUES},
        }
        for record in records
    ]


def _kept(values: list[Reals]) -> NDArray[np.int64]:
    """Indices of the samples that remain, with the first and the last one."""
    count = len(values[0])
    if count <= MOST_POINTS:
        return np.arange(count)
    groups = (MOST_POINTS - 2) // (2 * len(values))
    starts = np.linspace(0, count, groups, endpoint=False).astype(int)
    extremes = [
        start + place
        for each in values
        for start, group in zip(starts, np.split(each, starts[1:]), strict=True)
        for place in (int(group.argmin()), int(group.argmax()))
    ]
    return np.unique([0, *extremes, count - 1])


def rounded(values: Reals) -> list[float]:
    """Numbers with six digits."""
    return [float(f"{value:.6g}") for value in values.tolist()]
