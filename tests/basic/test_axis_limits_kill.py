"""The ends of the error band, whose excess kills an axis."""

import pytest
from tests.basic.motion_bench import Bench

KAMR_Y = 8499


@pytest.mark.req("ACR-CMD-EXC")
@pytest.mark.parametrize(
    ("target", "faults"), [(0.3, False), (0.301, True), (-0.2, False), (-0.201, True)]
)
def test_the_ends_of_the_error_band_belong_to_it(target: float, faults: bool) -> None:
    made = Bench("X", "Y").all("PPU X1000 Y1000", "ACC 0 DEC 100 STP 0 VEL 10")
    made.all("EXC Y(0.3,-0.2) : TLM Y0", "SET 8501", f"Y{target}").seconds(0.2)
    assert [made.bit(flag) for flag in (KAMR_Y, 8511)] == [faults] * 2
    assert made.bit(801) is not faults
    assert made.bit(769)
