"""Drives with a serial port in machine.toml: what is refused."""

import pytest
from tests.network.talk import axis, talking

from openacr.errors import SourceError
from openacr.plant.describe.load import parse_world


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (talking(0), "there is no axis 0 for the drive"),
        (axis(0) + talking(0) + talking(0), "two drives talk for axis 0"),
        (axis(0) + talking(0, type="leo"), '"aries"'),
        (axis(0) + talking(0, port="COM3"), '"COM1", "COM2"'),
        (axis(0) + talking(0, baud=1200), "baud is 1200; it must be one of 4800, 9600"),
        (axis(0) + talking(0, address=100), "a whole number from 0 to 99"),
        (axis(0) + talking(0, revision="two"), "revision"),
        (axis(0) + talking(0, back_s=3.0), "the drive is back at 3 s"),
        (axis(0) + talking(0, lost_s=3.0, back_s=2.0), "back at 2 s"),
        (axis(0) + talking(0, colour=2), "unknown key 'colour'"),
    ],
)
def test_contradictions_are_refused(text: str, says: str) -> None:
    with pytest.raises(SourceError) as refused:
        parse_world(text)
    assert says in str(refused.value)
