"""Faults of an emulated segment: what a master then sees."""

import pytest
from tests.fieldbus.ethercat.rig import Bus

from openacr.errors import UserError
from openacr.fieldbus.ethercat.emulated.build import drives_world, segment_of
from openacr.fieldbus.ethercat.emulated.faults import FAULTS, Line, helped
from openacr.fieldbus.ethercat.wire import frames, sii
from openacr.fieldbus.ethercat.wire.frames import Command
from openacr.fieldbus.ethercat.wire.registers import Register, State

ASKED = frames.pack([frames.by_station(Command.BRD, 0, Register.TYPE, b"\0")])


@pytest.fixture
def line() -> Line:
    return Line(segment_of(drives_world(1), digital=2), seed=1)


def counts(line: Line, frames_sent: int = 1000) -> list[int]:
    """How many frames came back for each that was sent."""
    return [len(line.send(ASKED, now)) for now in range(frames_sent)]


def counter(line: Line) -> int:
    """The working counter of a broadcast; -1 if nothing came back."""
    sent = line.send(ASKED, 0)
    return frames.parse(sent[0].frame)[0].counter if sent else -1


def test_a_cable_that_is_out_cuts_off_what_is_after_it(line: Line) -> None:
    assert counter(line) == 3
    assert line.command("cable-out 2") == "the cable in front of slave 2 is out"
    assert counter(line) == 2
    control = line.segment.slaves[1].controller
    assert control.get(Register.DL_STATUS, 2) & 0x0E20 == 0x0600
    assert control.memory[Register.LOST_LINKS + 1] == 1
    line.command("cable-out 0")
    assert counter(line) == -1
    line.command("cable-in")
    assert counter(line) == 3
    assert control.get(Register.DL_STATUS, 2) & 0x0E20 == 0x0A20


def test_a_slave_without_power_cuts_off_those_after_it_and_starts_in_init(line: Line) -> None:
    bus = Bus(line.segment)
    bus.op(1, 1, 1)
    bus.write(1, Register.STATION, b"\x05\0")
    line.command("power-off 1")
    assert counter(line) == 1
    line.command("power-on 1")
    assert counter(line) == 3
    assert bus.number(1, Register.AL_STATUS) == State.INIT
    assert bus.number(1, Register.STATION) == 0
    assert bus.cycle() == 0


def test_one_frame_in_n_is_lost_and_half_of_them_were_served(line: Line) -> None:
    assert line.command("lose 10") == "one frame in 10 is lost"
    lost = counts(line).count(0)
    assert 60 < lost < 140
    assert line.counts["lost"] == lost
    served = line.segment.frames - (1000 - lost)
    assert 0.3 < served / lost < 0.7
    assert line.command("lose 0") == "no longer"
    assert counts(line).count(0) == 0


def test_the_same_seed_loses_the_same_frames() -> None:
    def lost(seed: int) -> list[int]:
        one = Line(segment_of(drives_world(0), digital=1), seed)
        one.command("lose 5")
        return counts(one, 100)

    assert lost(3) == lost(3)
    assert lost(3) != lost(4)


def test_a_burst_loses_the_next_frames_alone(line: Line) -> None:
    line.command("burst 3")
    assert counts(line, 5) == [0, 0, 0, 1, 1]


def test_frames_come_late_and_twice(line: Line) -> None:
    line.command("late 1500")
    assert [each.delay_ns for each in line.send(ASKED, 0)] == [1_500_000]
    line.command("late 0")
    line.command("duplicate 1")
    first, second = line.send(ASKED, 0)
    assert first == second
    assert line.counts["duplicated"] == 1


def test_a_damaged_frame_differs_in_one_bit_of_its_datagrams(line: Line) -> None:
    right = line.send(ASKED, 0)[0].frame
    line.command("damage 1")
    for _ in range(50):
        wrong = line.send(ASKED, 0)[0].frame
        difference = int.from_bytes(right, "big") ^ int.from_bytes(wrong, "big")
        assert difference.bit_count() == 1
        assert right[: frames.FIRST] == wrong[: frames.FIRST]
    assert line.segment.slaves[0].controller.memory[Register.RX_ERRORS] == 50


def test_a_working_counter_is_one_too_small(line: Line) -> None:
    line.command("miscount 1")
    assert counter(line) == 2
    line.command("miscount 0")
    assert counter(line) == 3


def test_another_device_has_another_identity_until_the_right_one_is_back(line: Line) -> None:
    eeprom = line.segment.slaves[1].controller.eeprom
    right = sii.parse(bytes(eeprom.data))
    line.command("wrong 1")
    line.command("wrong 1")
    wrong = sii.parse(bytes(eeprom.data))
    assert wrong.identity.product == right.identity.product ^ 0x80000000
    assert wrong.identity.vendor == right.identity.vendor
    line.command("right 1")
    assert sii.parse(bytes(eeprom.data)) == right


def test_faults_of_drives_reach_the_drive(line: Line) -> None:
    assert "0x7305" in line.command("drive-fault 0 0x7305")
    assert "FAULT at 0, error 0x7305" in line.command("state")
    line.command("encoder-jump 0 -70")
    assert "at -70" in line.states()
    line.command("probe 0 1")
    with pytest.raises(UserError, match="slave 1 is digital, which is not a drive"):
        line.command("drive-mend 1")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("loose 5", "loose: the faults are cable-out, "),
        ("", "nothing: the faults are"),
        ("lose", "lose: write lose N"),
        ("lose 1 2", "lose 1 2: write lose N"),
        ("drive-fault", r"write drive-fault SLAVE \[CODE\]"),
        ("lose x", "lose x: x is not a whole number"),
        ("lose -1", "-1: 0 or more"),
        ("late 1000001", "a frame is 0 to 1000000 us late"),
        ("power-off 3", "power-off 3: slaves are numbered from 0 to 2"),
        ("power-off -1", "power-off -1: slaves are numbered from 0 to 2"),
        ("drive-fault 0 0", "0: error codes are from 1 to 0xFFFF"),
        ("encoder-jump 0 10000000000", "numbers are from"),
    ],
)
def test_a_wrong_command_says_how_it_is_written(line: Line, text: str, said: str) -> None:
    with pytest.raises(UserError, match=said):
        line.command(text)


def test_help_has_a_line_for_every_fault() -> None:
    assert [each.split()[0] for each in helped().splitlines()] == list(FAULTS)


def test_a_summary_counts_frames_and_what_happened(line: Line) -> None:
    line.command("burst 2")
    counts(line, 5)
    assert line.summary() == "5 frames, 2 lost"


@pytest.mark.parametrize("cut", range(0, 40))
def test_frames_that_are_cut_off_hurt_nothing(line: Line, cut: int) -> None:
    line.send(ASKED[:cut], 0)
    assert counter(line) == 3


def test_noise_hurts_nothing(line: Line) -> None:
    import random

    draw = random.Random(5)
    for now in range(3000):
        body = draw.randbytes(draw.randrange(12, 60))
        size = draw.choice([len(body), draw.randrange(0x800)]) | 0x1000
        line.send(ASKED[:14] + size.to_bytes(2, "little") + body, now)
        asked = frames.Datagram(
            draw.randrange(16), draw.choice([0, 0xFFFF]), draw.randrange(0x3000), body
        )
        line.send(frames.pack([asked]), now)
    assert counter(line) >= 0
