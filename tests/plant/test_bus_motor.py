"""Motors whose drives are on a bus: positions come from outside, captures from the drive."""

import pytest

from openacr.controller import Controller
from openacr.errors import SourceError
from openacr.map.rows import axes, bus_motors, encoders
from openacr.plant.describe.load import parse_world
from openacr.plant.describe.real_world import real_world
from openacr.plant.describe.schema import BusDrive

MACHINE = """
[bus]
interface = "eth9"

[[bus.terminal]]
position = 1
inputs_from = 10
inputs = 4
outputs_from = 40
outputs = 2

[[axis]]
number = 2
name = "Z"
counts_per_rev = 4000
marker = 0.0
travel = [-1.0, 1.0]
positive_limit = { at = 0.9, input = 6 }
drive = { mode = "exact" }

[axis.bus]
position = 0
mode = "csp"
inputs = { positive_limit = 6 }

[[axis]]
number = 0
name = "X"
counts_per_rev = 4000
drive = { mode = "exact" }
home = { between = [0.1, 0.2], input = 11 }

[inputs]
on = [12, 20]

[[wire]]
input = 13
output = 33
"""


class Outside:
    """What a bus would do: called at the end of ticks."""

    def __init__(self, every: int = 1) -> None:
        self.ticks: list[int] = []
        self.every = every

    def attend(self, tick: int) -> int:
        self.ticks.append(tick)
        return tick + self.every


_ATTACHED = ("ATTACH MASTER0", 'ATTACH SLAVE0 AXIS2 "Z"', "MULT Z4")


def card(text: str = MACHINE) -> Controller:
    world = real_world(parse_world(text))
    made = Controller(world.card.board, world=world)
    for line in ("SYS", "ATTACH AXIS2 ENC2 DAC2 ENC2", "PROG0", *_ATTACHED):
        made.send(line + "\r")
    return made


def test_a_motor_on_the_bus_is_where_its_drive_reports_it_and_nothing_else_moves_it() -> None:
    made = card()
    made.memory.F[bus_motors.reported_cnt[2]] = 123.5
    made.advance(2)
    assert made.memory.I[encoders.encoder_position[2]] == 123
    made.send("JOG FWD Z\r")
    made.advance(seconds=0.5)
    assert made.memory.I[encoders.encoder_position[2]] == 123


def test_hard_stops_and_switches_of_the_model_do_not_act_on_a_motor_on_the_bus() -> None:
    made = card()
    made.memory.F[bus_motors.reported_cnt[2]] = 20_000.5
    made.advance(2)
    assert made.memory.I[encoders.encoder_position[2]] == 20_000
    assert not made.bit[6]


@pytest.mark.parametrize(
    ("mode", "edge", "row", "latched"),
    [(2, 1, bus_motors.probe_rise_cnt, 77), (6, 2, bus_motors.probe_fall_cnt, -31)],
)
def test_a_capture_takes_the_position_that_the_drive_has_latched(
    mode: int, edge: int, row: tuple[int, ...], latched: int
) -> None:
    made = card()
    made.memory.I[bus_motors.has_probe[2]] = 1
    made.memory.F[bus_motors.reported_cnt[2]] = 100.5
    made.send(f"INTCAP Z{mode}\r")
    made.advance(3)
    made.memory.F[row[2]] = latched + 0.5
    made.memory.F[bus_motors.reported_cnt[2]] = 150.5
    made.memory.I[bus_motors.reported_edges[2]] = 3 - edge  # the other edge is not asked for
    made.advance(1)
    assert made.memory.I[axes.capture_mode[2]] == mode
    made.memory.I[bus_motors.reported_edges[2]] = edge
    made.advance(1)
    assert made.memory.I[axes.hardware_capture[2]] == latched
    assert made.memory.I[axes.capture_mode[2]] == -1


def test_with_a_probe_in_the_drive_the_input_of_the_card_captures_nothing() -> None:
    made = card()
    made.memory.I[bus_motors.has_probe[2]] = 1
    made.send("INTCAP Z2\r")
    made.advance(2)
    made.set_input(26, True)
    made.advance(2)
    assert made.memory.I[axes.capture_mode[2]] == 2


def test_inputs_that_the_bus_drives_are_driven_by_nothing_else() -> None:
    world = real_world(parse_world(MACHINE))
    assert world.inputs.on == (20,)
    assert world.inputs.off == (6, 10, 11, 12, 13)
    assert world.wire == ()
    z, x = world.axis
    assert isinstance(z.drive, BusDrive)
    assert (z.marker, z.travel, z.positive_limit) == (None, None, None)
    assert x.home is None


def test_real_devices_are_attended_in_the_ticks_they_ask_for_and_after_a_restart() -> None:
    made, outside = card(), Outside(every=3)
    made.advance(5)
    made.devices.join(outside)
    made.advance(7)
    assert outside.ticks == [6, 9, 12]
    made.send("REBOOT\r")
    made.advance(4)
    assert outside.ticks[3:] == [1, 4]


@pytest.mark.parametrize(
    ("old", "new", "text"),
    [
        ("position = 0", "alias = 4\nposition = 0", "has more than one of position, alias"),
        ("position = 0\n", "", "has none of position, alias and serial"),
        ("position = 1", "position = 0", "is at position 0, as the drive of axis Z"),
        ('mode = "csp"', 'mode = "csv"', 'mode = "csv" needs per_volt'),
        ('mode = "csp"', 'mode = "csp"\nper_volt = 2.0', "has no use for per_volt"),
        ('mode = "csp"', 'mode = "cst"\nper_volt = 0.0', "per_volt 0 commands nothing"),
        ('mode = "csp"', 'mode = "torque"', 'one of "csp", "csv", "cst"'),
        ("{ positive_limit = 6 }", "{ positive_limt = 6 }", "did you mean positive_limit?"),
        ("{ positive_limit = 6 }", "{ positive_limit = 33 }", "33, which is not an input"),
        ("{ positive_limit = 6 }", "{ positive_limit = 13 }", "two signals on input 13"),
        ("inputs = 4\n", "", "has only one of inputs and inputs_from"),
        ("outputs_from = 40", "outputs_from = 63", "leads to 64, which is not an output"),
        ('[bus]\ninterface = "eth9"\n', "", "no [bus]"),
    ],
)
def test_what_contradicts_itself_is_refused_with_its_name(old: str, new: str, text: str) -> None:
    changed = MACHINE.replace(old, new, 1)
    if old.startswith("[bus]"):
        changed = changed[changed.index("[[axis]]") :]
    with pytest.raises(SourceError) as refused:
        parse_world(changed)
    assert text in str(refused.value)
