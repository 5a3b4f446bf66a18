"""Devices of the machine on a card: wiring, time, restarts, snapshots, journals, errors."""

import re
from pathlib import Path

import msgspec
import pytest

from openacr.controller import Controller
from openacr.controller.journal import read_journal
from openacr.controller.recorder import Recorder
from openacr.controller.replay import Replay
from openacr.errors import SourceError, StoreError, UserError
from openacr.map import numbers as at
from openacr.map.rows import analogs, axes
from openacr.plant.describe.load import parse_world
from openacr.plant.describe.schema import World
from openacr.timeline import Timeline

AXIS = """
[[axis]]
number = 2
units_per_rev = 10.0
initial = 25.0
encoder_lines = 1000
drive = { mode = "ideal", revs_per_s_per_volt = 1.0 }
"""
GRIPPER = """
[[device]]
kind = "gripper"
name = "left"
outputs = { close = 34 }
inputs = { opened = 12, closed = 13, gripped = 14 }
settings = { close_s = 0.3, open_s = 0.1 }
"""
OWN = """\
from typing import ClassVar
from openacr.plant.devices.device import Device

class Probe(Device):
    COMMANDS: ClassVar = {"on": bool, "volts": float, "place": float, "hand": float, "key": bool}
    SIGNALS: ClassVar = {"seen": bool, "copy": float}
    factor: float = 1.0
    steps: int = 0
    _times: list[float] = []
    def step(self, dt_s, commands):
        self.steps += 1
        self._times.append(dt_s)
        return {"seen": commands["on"], "copy": commands["place"] * self.factor}
"""
PROBE = """
[[device]]
kind = "probe.py:Probe"
outputs = { on = 32 }
dacs = { volts = 3 }
axes = { place = 2 }
inputs = { seen = 10 }
analogs = { copy = 1 }
settings = { factor = 0.125 }
period_s = 0.0025
"""


def world(text: str) -> World:
    return parse_world(AXIS + text)


def card_of(text: str, folder: Path | None = None) -> Controller:
    return Controller(world=world(text), device_folder=folder)


@pytest.fixture
def probes(tmp_path: Path) -> Path:
    (tmp_path / "probe.py").write_text(OWN)
    return tmp_path


def levels(card: Controller) -> tuple[bool, bool, bool]:
    return card.bit[12], card.bit[13], card.bit[14]


# --- time -----------------------------------------------------------------------------


def test_signals_are_at_the_inputs_in_the_first_tick() -> None:
    card = card_of(GRIPPER)
    card.advance(1)
    assert levels(card) == (True, False, False)


def test_a_device_is_stepped_in_ticks_that_are_multiples_of_its_period() -> None:
    card = card_of(GRIPPER)
    card.advance(1)
    card.bit[34] = True
    card.advance(1)
    assert levels(card) == (True, False, False)  # its period is two ticks
    card.advance(1)
    assert levels(card) == (False, False, False)
    assert card.until(13, timeout_s=1.0)
    assert card.tick == 3 + 2 * 299  # the 300th step of 1 ms


def test_the_period_of_the_card_can_change(probes: Path) -> None:
    card = card_of(PROBE, probes)
    card.advance(5)
    card.send("SYS\rPERIOD 0.001\r")
    card.advance(20)
    (state,) = card.devices.state()
    device, _ = msgspec.json.decode(state)
    assert device["_times"][:2] == [0.0025, 0.002]  # five ticks of 0.5 ms, then two of 1 ms
    assert set(device["_times"][1:]) == {0.002}


# --- wiring ---------------------------------------------------------------------------


def test_commands_and_signals_of_every_kind_are_wired(probes: Path) -> None:
    card = card_of(PROBE, probes)
    card.send("SYS\rAXIS2 OFF\r")
    card.advance(1)
    assert not card.bit[10]
    card.bit[32] = True
    card.advance(6)
    assert card.bit[10]
    volts = analogs.reals[0] + analogs.REALS_SIZE + at.PLAF_VOLTS  # at input 1
    assert card.memory.F[volts] == 25.0 * 0.125
    card.drag(2, 400.0)  # pulses; four counts each
    card.advance(10)
    assert card.memory.F[volts] == 29.0 * 0.125


def test_volts_of_an_analog_output_reach_a_device() -> None:
    card = card_of(
        '[[device]]\nkind = "spindle"\noutputs = {forward = 33}\ndacs = {speed = 3}\n'
        "inputs = {at_speed = 7, stopped = 8}\n"
        "settings = {rpm_per_volt = 1000.0, rpm_per_s = 8000.0}\n"
    )
    card.send("SYS\rAXIS3 OFF\rP6448=4\r")
    card.bit[33] = True
    assert card.until(7, timeout_s=2.0)
    assert not card.bit[8]


def test_an_input_of_a_device_can_be_forced_and_released() -> None:
    card = card_of(GRIPPER)
    card.set_input(13, True)  # a stuck contact
    card.advance(10)
    assert levels(card) == (True, True, False)
    card.bit[34] = True
    card.set_input(12, True)
    card.advance(10)
    assert levels(card) == (True, True, False)
    card.release_input(12)
    card.release_input(13)
    assert levels(card) == (False, False, False)
    card.advance(700)
    assert levels(card) == (False, True, False)


def test_commands_without_a_wire_are_given_by_hand() -> None:
    card = card_of(GRIPPER)
    card.command("left", "part")
    card.bit[34] = True
    card.advance(700)
    assert levels(card) == (False, False, True)
    card.command("left", "part", 0.0)
    card.advance(700)
    assert levels(card) == (False, True, False)


@pytest.mark.parametrize(
    ("device", "name", "value", "sentence"),
    [
        ("right", "part", 1.0, "device 'right': known are left"),
        ("left", "close", 1.0,
         "command 'close' of left is wired to the card: by hand are given part"),
        ("left", "parts", 1.0, "command 'parts' of left does not exist: by hand are given part"),
        ("left", "part", float("nan"), "command 'part' of left: nan is not a finite number"),
    ],
)  # fmt: skip
def test_a_wrong_command_by_hand_is_refused(
    device: str, name: str, value: float, sentence: str
) -> None:
    card = card_of(GRIPPER)
    with pytest.raises(UserError, match=f"^{re.escape(sentence)}$"):
        card.command(device, name, value)
    assert card.journal == []


# --- what remains ---------------------------------------------------------------------


def test_a_restart_of_the_card_leaves_the_machine_as_it_is() -> None:
    card = card_of(GRIPPER)
    card.bit[34] = True
    card.advance(401)  # 201 of the 300 steps of the stroke, 67 of the 100 back
    card.send("SYS\rREBOOT\r")
    card.advance(1)  # the card is up again, its outputs are off: the jaws open
    assert card.tick == 1
    ticks = 0
    while not card.bit[12]:
        card.advance(1)
        ticks += 1
    assert ticks == 2 * 66  # the 67th step of 1 ms, the first of them in tick 1


def test_a_snapshot_holds_the_state_and_what_was_given_by_hand() -> None:
    card = card_of(GRIPPER)
    card.command("left", "part")
    card.bit[34] = True
    card.advance(151)
    snapshot = card.snapshot()
    card.advance(400)
    expected = card.digest()
    assert levels(card) == (False, False, True)
    card.command("left", "part", 0.0)
    card.advance(400)
    card.restore(snapshot)
    assert levels(card) == (False, False, False)
    card.advance(400)
    assert card.digest() == expected
    assert levels(card) == (False, False, True)


def test_a_snapshot_of_other_devices_is_refused_and_changes_nothing(probes: Path) -> None:
    card = card_of(PROBE, probes)
    card.advance(7)
    snapshot = card.snapshot()
    (probes / "probe.py").write_text(OWN.replace('"key": bool', '"other": bool'))
    again = card_of(PROBE, probes)
    again.advance(3)
    before = again.image(), again.devices.state()
    with pytest.raises(StoreError, match=r"^the snapshot is of another version of probe\.py:Probe"):
        again.restore(snapshot)
    assert (again.image(), again.devices.state()) == before
    (probes / "probe.py").write_text(OWN.replace("factor: float", "factor: str"))
    third = Controller(world=world(PROBE.replace("0.125", '"x"')), device_folder=probes)
    with pytest.raises(StoreError, match="another machine"):
        third.restore(snapshot)


def test_a_journal_replays_a_device_and_commands_by_hand(tmp_path: Path) -> None:
    card, path = card_of(GRIPPER), tmp_path / "a.journal"
    card.advance(11)
    card.recorder = Recorder(card, path)
    card.bit[34] = True
    card.advance(100)
    card.command("left", "part")
    card.advance(2500)
    card.command("left", "part", 0.0)
    card.advance(1500)
    card.close()
    again = Replay(read_journal(path))
    again.run()
    assert (again.difference, again.equal) == (None, 3)
    assert levels(again.card) == (False, True, False)


def test_the_journal_of_an_own_device_needs_the_folder_of_its_code(probes: Path) -> None:
    card, path = card_of(PROBE, probes), probes / "a.journal"
    card.recorder = Recorder(card, path)
    card.advance(2100)
    card.close()
    journal = read_journal(path)
    with pytest.raises(UserError, match=r"^the device probe\.py:Probe is Python code, and no"):
        Replay(journal)
    again = Replay(journal, probes)
    again.run()
    assert (again.difference, again.equal) == (None, 2)


def test_a_branch_of_time_has_its_own_devices(probes: Path) -> None:
    card = card_of(PROBE + GRIPPER, probes)
    history = Timeline(card)
    history.advance(100)
    card.bit[34] = True
    history.advance(300)
    image, states = card.image(), card.devices.state()
    history.seek(150)
    assert card.devices.state() != states
    history.seek(400)
    assert (card.image(), card.devices.state()) == (image, states)


# --- errors ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ('kind = "griper"', "the device kind 'griper' is not known"),
        ('kind = "gripper"\noutputs = {shut = 33}', "gripper has no command 'shut' for outputs"),
        ('kind = "spindle"\noutputs = {speed = 33}', "spindle has no command 'speed' for outputs"),
        ('kind = "gripper"\ndacs = {close = 0}', "gripper has no command 'close' for dacs"),
        ('kind = "gripper"\ninputs = {close = 9}', "gripper has no signal 'close' for inputs"),
        ('kind = "gripper"\nanalogs = {opened = 1}', "gripper has no signal 'opened' for analogs"),
        (
            'kind = "gripper"\nsettings = {close = 1}',
            "gripper: no setting 'close': close_s",
        ),
        ('kind = "gripper"\nsettings = {_stroke = 1}', "gripper: no setting '_stroke': close_s"),
        ('kind = "gripper"\nsettings = {close_s = 0}', "gripper: settings: Expected `float` > 0.0"),
        ('kind = "gripper"\noutputs = {close = 9}', "output 9 is not an output"),
        ('kind = "gripper"\ninputs = {opened = 40}', "opened of gripper is wired to 40"),
        ('kind = "spindle"\naxes = {speed = 0}', "there is no axis 0"),
        ('kind = "gripper"\nname = "left"', "two devices are called 'left'"),
        ('kind = "gripper"\ninputs = {opened = 13}', "two wires on input 13: "),
    ],
)
def test_a_device_that_cannot_be_is_refused_with_its_line(text: str, sentence: str) -> None:
    with pytest.raises(SourceError) as caught:
        world(GRIPPER + "[[device]]\n" + text)
    assert caught.value.text.startswith(sentence), caught.value.text
    assert caught.value.line is not None
    assert caught.value.line >= (AXIS + GRIPPER).count("\n") - 3


def test_two_sources_of_one_analog_input_are_refused() -> None:
    spindle = '[[device]]\nkind = "spindle"\nname = "{}"\nanalogs = {{speed = 3}}\n'
    with pytest.raises(SourceError, match="two voltages at analog input 3"):
        world("[[analog]]\ninput = 3\nvolts = 1.0\n" + spindle.format("a"))
    with pytest.raises(SourceError, match="two voltages at analog input 3"):
        world(spindle.format("a") + spindle.format("b"))


@pytest.mark.parametrize(
    ("code", "sentence"),
    [
        ("", r"probe\.py has no class Probe that is a Device"),
        ("class Probe:\n    pass\n", r"probe\.py has no class Probe that is a Device"),
        ("Probe = 1 / 0\n", r"probe\.py: ZeroDivisionError: division by zero"),
        ("def (\n", r"probe\.py: SyntaxError: "),
        (OWN.replace('"on": bool', '"on": int'),
         r"probe\.py: commands and signals of Probe are bool or float"),
        (OWN.replace('"volts": float, ', ""), r"has no command 'volts' for dacs \(known: place"),
    ],
)  # fmt: skip
def test_an_own_class_that_cannot_be_used_is_refused(
    tmp_path: Path, code: str, sentence: str
) -> None:
    (tmp_path / "probe.py").write_text(code)
    with pytest.raises(UserError, match=sentence):
        card_of(PROBE, tmp_path)


def test_a_file_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(UserError, match=r"probe\.py cannot be read: No such file"):
        card_of(PROBE, tmp_path)


@pytest.mark.parametrize(
    ("answer", "sentence"),
    [
        ("1 / 0", "has failed in its step: ZeroDivisionError: division by zero"),
        ("None", "has failed in its step: TypeError: "),
        ('{"sen": True}', "gives a signal 'sen': it has seen, copy"),
        ('{"copy": float("nan")}', "gives copy as nan: it must be a finite number of volts"),
        ('{"copy": "4"}', "gives copy as '4': it must be a finite number of volts"),
    ],
)
def test_a_device_that_fails_ends_the_run_with_its_name(
    tmp_path: Path, answer: str, sentence: str
) -> None:
    code = re.sub(r"return .*", f"return {answer}", OWN)
    (tmp_path / "probe.py").write_text(code)
    card = card_of(PROBE, tmp_path)
    with pytest.raises(UserError, match=f"^the device probe.py:Probe {re.escape(sentence)}"):
        card.advance(1)


def test_an_edge_of_a_device_is_captured_at_the_end_of_the_next_servo_interrupt() -> None:
    card = card_of(GRIPPER.replace("closed = 13", "closed = 26"))  # external input of axis 2
    for line in (
        "PROG0", "ATTACH MASTER0", 'ATTACH SLAVE0 AXIS2 "X"', "PPU X400", "PGAIN X0.01",
        "DRIVE ON X", "JOG VEL X100", "JOG ACC X10000", "JOG FWD X", "INTCAP X2", "SET 34",
    ):  # fmt: skip
        card.send(f"{line}\r")
    assert card.until(26, timeout_s=1.0)
    before_cnt = card.p[axes.actual_position[2]]
    card.advance(1)
    after_cnt = card.p[axes.actual_position[2]]
    assert after_cnt > before_cnt
    assert card.p[axes.hardware_capture[2]] == after_cnt
    card.advance(100)
    assert card.p[axes.hardware_capture[2]] == after_cnt
