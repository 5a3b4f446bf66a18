"""Read-out formats of the DISPLAY tab."""

import pytest

from openacr.mill.config.readout import Format, Readout
from openacr.sysvar import Store

INCH_X, METRIC_X, CONTROL_MODE = 850_000, 850_001, 850_030


@pytest.mark.req("MILL-SYS-DISP-RES")
def test_digits_left_and_right_of_the_point_by_axis_and_unit() -> None:
    store = Store()
    store.write(INCH_X, 3.6)
    store.write(METRIC_X, 4.2)
    readout = Readout(store)
    assert (readout.format(0), readout.format(1)) == (Format(3, 6), Format(3, 4))
    assert readout.text(0, 12.25) == "  12.250000"
    assert readout.text(0, -123.4567891) == "-123.456789"
    assert readout.text(0, 2.0, is_metric=True) == "   50.80"
    assert readout.text(1, 12.25) == "  12.2500"


@pytest.mark.req("MILL-SYS-DISP-RES-DEFAULT")
def test_formats_are_3_4_for_inch_and_4_5_for_mm() -> None:
    readout = Readout(Store())
    assert readout.line((0, 1), (1.0, -0.00001)) == "X   1.0000 Y   0.0000"
    store = Store()
    store.write(CONTROL_MODE, 21)
    assert Readout(store).line((0,), (1.0,)) == "X   25.40000"


def test_rotary_axes_are_degrees_in_both_units_and_no_digit_is_cut() -> None:
    readout = Readout(Store())
    assert readout.text(3, 90.0, is_metric=True) == "   90.00000"
    assert readout.text(0, 1234567.0) == "1234567.0000"
