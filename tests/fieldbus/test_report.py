"""What a bus reports of itself: devices, drives, counters."""

import json

import pytest
from tests.fieldbus.bus_rig import OnBus
from tests.fieldbus.test_drives_on_a_card import lose, machine, moving

from openacr.fieldbus.cia402.faults import fault_text, group_of
from openacr.fieldbus.ethercat.wire.registers import State


def test_a_bus_reports_its_devices_drives_and_settings_as_json() -> None:
    made = OnBus(machine(axes=2, more="cycle = 2\n"), digital=1)
    made.card.advance(400)
    report = json.loads(json.dumps(made.machine.report()))
    assert (report["interface"], report["is_real"], report["cycle_s"]) == ("emulated", True, 0.001)
    assert (report["alarm"], report["is_coming_up"]) == ("", False)
    states = [(one["position"], one["name"], one["state"]) for one in report["devices"]]
    assert states == [(0, "drive", "OP"), (1, "drive", "OP"), (2, "digital", "PREOP")]
    shown = [(one["axis"], one["position"], one["state"]) for one in report["drives"]]
    assert shown == [("X", 0, "DISABLED"), ("Y", 1, "DISABLED")]


def test_a_drive_in_motion_shows_mode_target_and_position() -> None:
    made = moving()
    drive = made.machine.report()["drives"][0]
    assert (drive["state"], drive["mode"], drive["is_enabled"]) == ("OPERATING", 8, True)
    assert 0 <= drive["actual"] - made.position() <= 40  # what it moves in a period
    assert 0 < drive["target"] - drive["actual"] < 200


def test_a_drive_that_is_not_heard_shows_no_state() -> None:
    made = moving()
    lose(made, 1)
    made.card.advance(1)
    assert made.machine.report()["drives"][0]["state"] == ""
    made.card.advance(1)
    assert made.machine.report()["drives"][0]["state"] == "OPERATING"


def test_a_fault_is_shown_with_its_code_and_meaning() -> None:
    made = moving()
    made.drive().fault(0x8611)
    made.card.advance(1000)
    drive = made.machine.report()["drives"][0]
    assert (drive["state"], drive["code"], drive["text"]) == ("FAULT", 0x8611, "following error")
    assert drive["alarm"] == "it reports fault 0x8611 (following error)"
    assert not drive["is_enabled"]


@pytest.mark.parametrize(
    ("code", "group", "text"),
    [
        (0x2310, 0x2310, "continuous overcurrent at the motor"),
        (0x2312, 0x2310, "continuous overcurrent at the motor"),
        (0x2399, 0x2300, "current at the motor"),
        (0x2999, 0x2000, "current"),
        (0xFF05, 0xFF00, "of its maker"),
        (0x0000, 0, ""),
        (0xA123, 0, ""),
    ],
)
def test_a_code_without_a_text_has_that_of_its_group(code: int, group: int, text: str) -> None:
    assert (group_of(code), fault_text(code)) == (group, text)


def test_frames_are_counted_by_what_became_of_them_until_the_counters_are_reset() -> None:
    made = OnBus(machine())
    made.machine.reset_counters()
    made.card.advance(10)
    assert made.machine.counters == {"sent": 10, "lost": 0, "wrong": 0, "late": 0}
    lose(made, 2)
    made.card.advance(5)
    assert made.machine.counters == {"sent": 15, "lost": 2, "wrong": 0, "late": 2}
    made.link.now_ns += 2_000_000
    made.card.advance(1)
    assert made.machine.counters == {"sent": 16, "lost": 2, "wrong": 0, "late": 3}
    made.machine.reset_counters()
    assert made.machine.counters["sent"] == 0


def test_a_wrong_working_counter_is_no_lost_frame() -> None:
    made = OnBus(machine(axes=2))
    made.segment.power(1, False)
    made.machine.reset_counters()
    made.card.advance(3)
    assert (made.machine.counters["lost"], made.machine.counters["wrong"]) == (0, 3)


def test_a_device_that_leaves_its_state_or_is_gone_is_shown_so() -> None:
    made = OnBus(machine(axes=2))
    made.machine._master.devices[1].request(State.PREOP)
    made.card.advance(300)
    assert [one["state"] for one in made.machine.report()["devices"]] == ["OP", "PREOP"]
    made.segment.power(1, False)
    made.card.advance(300)
    assert [one["state"] for one in made.machine.report()["devices"]][1] == ""


def test_a_device_with_an_error_shows_its_code_and_text() -> None:
    made = OnBus(machine(axes=2))
    made.link.now_ns += 150_000_000  # longer than the watchdog of the drives
    made.card.advance(300)
    shown = made.machine.report()["devices"][1]
    assert (shown["state"], shown["code"]) == ("SAFEOP", 0x1B)
    assert shown["text"] == "sync manager watchdog"
