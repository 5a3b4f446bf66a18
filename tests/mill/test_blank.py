"""Blank of a program: where the cutting sizes of the store put its box."""

import pytest

from openacr.mill.plan.pictures.blank import SIZES, blank_of
from openacr.sysvar import Store

CUTS = (0.0, 0.0), (20.0, 10.0)


@pytest.mark.req("MILL-SYS-CTL-ZSIZE")
@pytest.mark.parametrize("is_metric", [True, False])
@pytest.mark.parametrize(
    ("low", "high", "zero", "size", "box"),
    [
        (-3.0, 5.0, 0.0, 8.0, (-8.0, 0.0)),  # cuts below Z0: Z0 is the top of the blank
        (-3.0, 5.0, 0.0, 0.0, (-3.0, 0.0)),
        (-3.0, -1.0, 0.0, 2.0, (-2.0, 0.0)),  # as large as its size, though a cut is deeper
        (-13.0, -5.0, -10.0, 8.0, (-18.0, -10.0)),
        (1.0, 5.0, 0.0, 8.0, (0.0, 8.0)),  # all cuts above: Z0 is the bottom
        (0.0, 5.0, 0.0, 8.0, (0.0, 8.0)),
        (1.0, 5.0, 0.0, 0.0, (0.0, 5.0)),
    ],
)
def test_the_z_cutting_size_counts_down_from_z0_or_up_from_it(
    low: float,
    high: float,
    zero: float,
    size: float,
    box: tuple[float, float],
    is_metric: bool,
) -> None:
    store = Store(is_metric=is_metric)
    for cell, value in zip(SIZES, (60.0, 40.0, size), strict=True):
        store.write(cell, value)
    blank = blank_of(store, (*CUTS[0], low), (*CUTS[1], high), zero)
    assert (blank.low[2], blank.high[2]) == pytest.approx(box)
    assert (blank.low[:2], blank.high[:2]) == ((-20.0, -15.0), (40.0, 25.0))
