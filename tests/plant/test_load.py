"""Every mistake in a machine file is named with its place, its value and what is allowed."""

from pathlib import Path

import pytest

from openacr.errors import SourceError, UserError
from openacr.plant.describe.load import load_world, parse_world
from openacr.plant.describe.schema import Contact, IdealDrive, TorqueDrive

IDEAL = 'drive = { mode = "ideal", revs_per_s_per_volt = 5.0 }\n'
HEAD = "[[axis]]\nnumber = 0\nname = 'X'\nencoder_lines = 1000\n"
X = HEAD + IDEAL
Y = X.replace("number = 0", "number = 1").replace("'X'", "'Y'")
TORQUE = 'drive = { mode = "torque", amps_per_volt = 1.0, peak_amps = 9.0 }\n'
MOTOR = "motor = { inertia_kgm2 = 1e-5, torque_nm_per_a = 0.5 }\n"
FAULTS = {
    "[card]\nmodel = 'ACR90'\n":
        'machine.toml:2:1: card.model is "ACR90"; it must be one of "ACR1200", "ACR1500", '
        '"ACR1505", "ACR2000", "ACR8000", "ACR8010", "ACR8020", "ACR9000", "ACR9030", '
        '"ACR9040"',
    "[card]\nperiod_s = 0.5\n":
        "machine.toml:2:1: card.period_s is 0.5; it must be a number from 0.0001 to 0.005",
    "[card]\ndac_bits = 16.5\n":
        "machine.toml:2:1: card.dac_bits is 16.5; it must be a whole number from 8 to 16",
    "[card]\nperiode_s = 0.5\n":
        "machine.toml:2:1: unknown key 'periode_s' in [card] (did you mean 'period_s'?)",
    "[card]\nxyz = 1\n":
        "machine.toml:2:1: unknown key 'xyz' in [card]"
        " (known keys: model, period_s, dac_bits, short_override_packets, digits_in_names)",
    "card = 1\n": "machine.toml:1:1: card is 1; it must be a table",
    "[[axes]]\n": "machine.toml:1:3: unknown key 'axes' in the file (did you mean 'axis'?)",
    "[axis]\nnumber = 1\n": "machine.toml:1:2: axis is a table; it must be a list of tables",
    "[[axis]]\nnumber = 0\n":
        "machine.toml:1:3: [axis] lacks the key 'drive' (known keys: number, drive, name, units, "
        "encoder_lines, counts_per_rev, encoder_direction, units_per_rev, initial, marker, travel, "
        "dac, motor, load, positive_limit, negative_limit, home, bus, body)",
    X.replace("number = 0", "number = 16"):
        "machine.toml:2:1: axis[0].number is 16; it must be a whole number from 0 to 15",
    X.replace("number = 0", "number = true"):
        "machine.toml:2:1: axis[0].number is true; it must be a whole number from 0 to 15",
    X + "name2 = 5\n": "machine.toml:6:1: unknown key 'name2' in [axis] (did you mean 'name'?)",
    X + "units = 5\n": "machine.toml:6:1: axis[0].units is 5; it must be a text in quotes",
    X + "units_per_rev = 0\n":
        "machine.toml:6:1: axis[0].units_per_rev is 0; it must be a number above 0 to 1e+09",
    X + "initial = nan\n":
        "machine.toml:6:1: axis[0].initial is nan; it must be a finite number",
    X + "travel = [0, inf]\n":
        "machine.toml:6:1: axis[0].travel[1] is inf; it must be a finite number",
    X + "travel = [1]\n":
        "machine.toml:6:1: axis[0].travel is [1]; it must be a list of 2 values, each a number "
        "from -1e+09 to 1e+09",
    X + "encoder_direction = 'left'\n":
        'machine.toml:6:1: axis[0].encoder_direction is "left"; it must be one of "up", "down"',
    HEAD + "[axis.drive]\nmode = 'magic'\n":
        'machine.toml:6:1: axis[0].drive.mode is "magic"; it must be one of "torque", "velocity", '
        '"ideal", "phases", "stepper", "exact"',
    HEAD + "[axis.drive]\npeak_amps = 1.0\n":
        "machine.toml:5:2: [axis.drive] lacks the key 'mode' (known keys: mode)",
    HEAD + "[axis.drive]\nmode = 'ideal'\npeak_amps = 1.0\nrevs_per_s_per_volt = 1\n":
        "machine.toml:7:1: unknown key 'peak_amps' in [axis.drive] (known keys: mode, "
        "fault_input, fault_contact, offset_v, revs_per_s_per_volt, lag_s)",
    X + "[axis.load]\nviscous_nms = -1\n":
        "machine.toml:7:1: axis[0].load.viscous_nms is -1; it must be a number from 0 to 1e+06",
    HEAD + TORQUE + "[axis.motor]\ninertia_kgm2 = -1\ntorque_nm_per_a = 1\n":
        "machine.toml:7:1: axis[0].motor.inertia_kgm2 is -1; it must be a number above 0 to 1e+06",
    X + "[[wire]]\ninput = 1\nregion = { X = ['a', 2] }\n":
        'machine.toml:8:1: wire[0].region is a table; it must be a table of axes, each a list of 2 '
        "values, each a number from -1e+09 to 1e+09",
    X + X.replace("'X'", "'Y'"):
        "machine.toml:7:1: two axes have the number 0 (the other is axis[0])",
    X + Y.replace("'Y'", "'x'"):
        "machine.toml:8:1: two axes have the name x (the other is axis[0])",
    X + "[axis.body]\ncolor = '#00ff00'\n":
        "machine.toml:7:1: unknown key 'color' in [axis.body] (did you mean 'colour'?)",
    X + "[axis.body]\nsize = [10, 0, 10]\n":
        "machine.toml:7:1: axis[0].body.size[1] is 0; it must be a number above 0 to 1e+06",
    X + "[axis.body]\ndirection = [0, 1.5, 0]\n":
        "machine.toml:7:1: axis[0].body.direction[1] is 1.5; it must be a number from -1 to 1",
    X + "[axis.body]\ndirection = [0, 0, 0]\n":
        "machine.toml:7:1: axis X: the direction is 0, 0, 0"
        " (X is [1, 0, 0]; other lengths mean the same)",
    X + "[axis.body]\ncolour = '00ff00'\n":
        "machine.toml:7:1: axis X: the colour is '00ff00'"
        ' (red, green and blue from 00 to ff: "#3b82f6")',
    X + "[axis.body]\nfile = 'slide.step'\n":
        "machine.toml:7:1: axis X: 'slide.step' is no file with a body"
        " (its name ends in .stl or .glb)",
    X + "[axis.body]\nfile = '../slide.stl'\n":
        "machine.toml:7:1: axis X: '../slide.stl' is outside the folder of the machine"
        " (give a name in the folder of machine.toml)",
    X + "[axis.body]\nfile = '/slide.stl'\n":
        "machine.toml:7:1: axis X: '/slide.stl' is outside the folder of the machine"
        " (give a name in the folder of machine.toml)",
    X + "[axis.body]\nfile = 'slide.stl'\nsize = [1, 1, 1]\n":
        "machine.toml:8:1: axis X: the body has both a file and the size of a box"
        " (give one of them)",
    X + "[axis.body]\nparent = 'Q'\n":
        "machine.toml:7:1: there is no axis 'Q' (axes: X; \"\": the ground)",
    X + "[axis.body]\nparent = 'x'\n":
        "machine.toml:7:1: axis X carries itself: X on X (the ground is parent = \"\")",
    X + "[axis.body]\nparent = 'Y'\n" + Y:
        "machine.toml:7:1: axis X carries itself: X on Y on X (the ground is parent = \"\")\n"
        "machine.toml:8:3: axis Y carries itself: Y on X on Y (the ground is parent = \"\")",
    X + "[axis.body]\nparent = 'X'\n" + Y + "[axis.body]\nparent = 'X'\n":
        "machine.toml:7:1: axis X carries itself: X on X (the ground is parent = \"\")",
    X + "[[device]]\nkind = 'gripper'\nsign = { at = [0, 0, 0], parent = 'Z' }\n":
        "machine.toml:8:26: there is no axis 'Z' (axes: X; \"\": the ground)",
    X + "counts_per_rev = 4000\n":
        "machine.toml:1:3: axis X has both of encoder_lines and counts_per_rev (give one of them; "
        "an encoder has four counts per line)",
    X.replace("encoder_lines = 1000\n", ""):
        "machine.toml:1:3: axis X has neither of encoder_lines and counts_per_rev (give one of "
        "them; an encoder has four counts per line)",
    X + MOTOR:
        'machine.toml:6:1: axis X: an ideal drive has no use for a motor (or set mode = "torque")',
    HEAD + TORQUE:
        "machine.toml:1:3: axis X: the motor is missing (add [axis.motor]; only an ideal or exact "
        "drive needs none)",
    HEAD + MOTOR + TORQUE.replace(" }", ", supply_v = 80 }"):
        "machine.toml:6:66: axis X: supply_v limits nothing without resistance_ohm of the motor "
        "(add resistance_ohm to [axis.motor])",
    X + "load = { inertia_kgm2 = 1, resonance_hz = 50 }\n":
        'machine.toml:6:28: axis X: only torque makes a load swing (leave it away, or set mode = '
        '"torque")',
    HEAD + MOTOR + TORQUE + "load = { resonance_hz = 50 }\n":
        "machine.toml:7:10: axis X: resonance_hz swings nothing without inertia_kgm2 of the load"
        " (add inertia_kgm2 to [axis.load])",
    X + "load = { damping_ratio = 1 }\n":
        "machine.toml:6:10: axis[0].load.damping_ratio is 1; it must be a number from 0 to 0.9",
    X + "load = { coulomb_nm = 2, static_nm = 1 }\n":
        "machine.toml:6:26: axis X: static_nm 1 is below coulomb_nm 2 (static friction is never "
        "less than the friction of motion)",
    X + "travel = [5, 1]\n":
        "machine.toml:6:1: axis X: travel goes from 5 to 1 (give the lower end first)",
    X + "travel = [1, 5]\n": "machine.toml:1:3: axis X: initial 0 is outside the travel 1 to 5",
    X + "travel = [-1, 5]\ninitial = 6\n":
        "machine.toml:7:1: axis X: initial 6 is outside the travel -1 to 5",
    X + "travel = [-1, 5]\n[axis.positive_limit]\nat = 6\n":
        "machine.toml:7:2: axis X: positive_limit at 6 is outside the travel -1 to 5 (the axis "
        "would never reach it)",
    X + "travel = [-1, 5]\n[axis.negative_limit]\nat = -6\n":
        "machine.toml:7:2: axis X: negative_limit at -6 is outside the travel -1 to 5 (the axis "
        "would never reach it)",
    X + "positive_limit = { at = 1 }\nnegative_limit = { at = 2 }\n":
        "machine.toml:7:20: axis X: negative_limit at 2 is not below positive_limit at 1",
    X + "home = { between = [2, 1] }\n":
        "machine.toml:6:1: axis X: home is active between 2 and 1 (give the lower end first)",
    X + "positive_limit = { at = 1, input = 2 }\nhome = { between = [0, 1] }\n":
        "machine.toml:7:1: two wires on input 2: positive_limit of axis X and home of axis X",
    X + "positive_limit = { at = 1, input = 33 }\n":
        "machine.toml:6:28: positive_limit of axis X is wired to 33, which is not an input (inputs "
        "are 0 to 31, 256 to 287, 320 to 351, 384 to 415, 448 to 479)",
    X + "[[wire]]\ninput = 4\n":
        "machine.toml:6:3: the wire to input 4 has neither a region nor an output (give one of "
        "them)",
    X + "[[wire]]\ninput = 4\noutput = 32\nregion = { X = [1, 2] }\n":
        "machine.toml:6:3: the wire to input 4 has both a region and an output (give one of them)",
    X + "[[wire]]\ninput = 4\noutput = 3\n":
        "machine.toml:8:1: output 3 is not an output (outputs are 32 to 63, 288 to 319, 352 to "
        "383, 416 to 447, 480 to 511)",
    X + "[[wire]]\ninput = 4\ndelay_s = 1\nregion = { X = [1, 2] }\n":
        "machine.toml:8:1: delay_s has a meaning only with output",
    X.replace("'X'", "'ROLL'") + "[[wire]]\ninput = 4\nregion = { ROL = [1, 2] }\n":
        "machine.toml:8:12: the region names the unknown axis 'ROL' (did you mean ROLL?)",
    X + "[[wire]]\ninput = 4\nregion = { Q = [1, 2] }\n":
        "machine.toml:8:12: the region names the unknown axis 'Q' (axes: X)",
    X + "[[wire]]\ninput = 4\nregion = { X = [2, 1] }\n":
        "machine.toml:8:12: the range of X goes from 2 to 1 (give the lower end first)",
    X + "[[wire]]\ninput = 4\nregion = { }\n": "machine.toml:8:1: the region names no axis",
    X + "[[wire]]\nname = 'door'\ninput = 4\noutput = 32\n[inputs]\non = [3, 4]\n":
        "machine.toml:11:1: two wires on input 4: door and the constant level on",
    "[inputs]\non = [3]\noff = [3]\n":
        "machine.toml:3:1: two wires on input 3: the constant level on and the constant level off",
    HEAD + IDEAL.replace(" }", ", fault_input = 99 }"):
        "machine.toml:5:54: axis X: fault_input 99 is not an input (inputs are 0 to 31, 256 to "
        "287, 320 to 351, 384 to 415, 448 to 479)",
    "[card\n":
        "machine.toml:1:6: expected ']' at the end of a table declaration",
    "[card]\nmodel = 'ACR9000": "machine.toml:2: expected \"'\"",
}  # fmt: skip


@pytest.mark.parametrize(("text", "expected"), FAULTS.items())
def test_a_mistake_is_reported_with_place_value_and_allowed_values(
    text: str, expected: str
) -> None:
    with pytest.raises(SourceError) as caught:
        parse_world(text)
    assert str(caught.value) == expected


def test_more_conditions_than_there_is_room_for_are_refused() -> None:
    wires = "".join(
        f"[[wire]]\ninput = {n}\nregion = {{ X = [0, 1], Y = [0, 1], Z = [0, 1] }}\n"
        for n in range(22)
    )
    axes = X + Y + Y.replace("number = 1", "number = 2").replace("'Y'", "'Z'")
    with pytest.raises(SourceError, match="66 switches, ranges and wires are more than 64"):
        parse_world(axes + wires)


def test_a_missing_file_is_reported_by_name(tmp_path: Path) -> None:
    with pytest.raises(UserError, match=r"none\.toml: cannot be read: no such file"):
        load_world(tmp_path / "none.toml")


def test_a_file_that_is_not_utf8_is_reported_with_its_line(tmp_path: Path) -> None:
    path = tmp_path / "machine.toml"
    path.write_bytes(b"[card]\nmodel = '\xff'\n")
    with pytest.raises(SourceError, match=r"machine\.toml:2: the file is not UTF-8 text"):
        load_world(path)


def test_the_place_is_found_after_long_texts_and_lists() -> None:
    text = (
        X
        + 'units = """\n[card]\nperiod_s = 3\n"""\n[inputs]\non = [\n  1, # [\n  2,\n]\nof = [3]\n'
    )
    with pytest.raises(SourceError) as caught:
        parse_world(text)
    assert (caught.value.line, caught.value.column) == (15, 1)


def test_a_good_file_gives_its_values(tmp_path: Path) -> None:
    path = tmp_path / "machine.toml"
    text = HEAD + TORQUE + MOTOR + 'home = { between = [1, 2], contact = "closed" }\n'
    path.write_text("\ufeff" + text, encoding="utf-8")
    axis = load_world(path).axis[0]
    assert axis.drive == TorqueDrive(amps_per_volt=1.0, peak_amps=9.0)
    assert axis.home is not None
    assert (axis.home.between, axis.home.contact) == ((1.0, 2.0), Contact.CLOSED)
    assert (axis.counts, axis.counts_per_unit, axis.label) == (4000, 4000.0, "X")


def test_an_empty_file_is_a_card_without_motors() -> None:
    world = parse_world("")
    assert (world.axis, world.card.model, world.card.period_s) == ((), "ACR9000", 0.0005)


def test_an_ideal_drive_needs_no_motor() -> None:
    assert parse_world(X).axis[0].drive == IdealDrive(revs_per_s_per_volt=5.0)
