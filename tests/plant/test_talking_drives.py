"""Drives with a serial port in machine.toml: what is refused."""

import pytest
from tests.network.talk import axis, talking

from openacr.controller import Controller
from openacr.errors import SourceError
from openacr.map.rows import bus_drives
from openacr.plant.bus import aries
from openacr.plant.describe.load import parse_world
from openacr.plant.describe.real_world import is_real, real_world


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


def test_a_serial_port_leads_to_one_port_of_the_card() -> None:
    motors = axis(0) + axis(1)
    one, other = (talking(n, serial="/dev/a", port=f"COM{n + 1}") for n in range(2))
    with pytest.raises(SourceError, match="/dev/a is COM2 for axis 1, COM1 for another"):
        parse_world(motors + one + other)


def test_real_drives_and_those_on_a_bus_have_no_modelled_line_while_it_is_open() -> None:
    bus = '[bus]\ninterface = "eth1"\n'
    on_bus = axis(2) + '[axis.bus]\nposition = 0\nmode = "csp"\n'
    lines = talking(0, serial="/dev/a") + talking(1) + talking(2)
    real = real_world(parse_world(bus + axis(0) + axis(1) + on_bus + lines))
    assert [drive.axis for drive in real.drive] == [1]
    assert Controller(world=real).memory.I[bus_drives.kind[1]] == aries.ARIES
    serial = parse_world(axis(0) + talking(0, serial="/dev/a"))
    assert is_real(serial) and not is_real(parse_world(axis(0) + talking(0)))
