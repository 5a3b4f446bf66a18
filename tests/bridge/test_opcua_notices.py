"""What has happened from one reading to the next."""

from dataclasses import replace

import pytest

from openacr.bridge.opcua.notices import FAULT, NEWS, NOTE, Notice, Notices
from openacr.bridge.rows import Alarm, Value

IDLE: dict[str, Value] = {
    "available": True, "state": "IDLE", "program": "plate.nc", "message": "", "alarms": (),
}  # fmt: skip
MILD, HARD = Alarm(34, "X: drive is off", "REFUSE"), Alarm(3, "link lost", "ABORT")


def notices_of(*changes: dict[str, Value]) -> list[Notice]:
    """All notices of readings, each with these values instead of those of an idle machine."""
    notices = Notices()
    readings = [IDLE | change for change in changes]
    return [each for values in readings for each in notices.of(values)]


def texts(*states: str | None) -> list[str]:
    changes: list[dict[str, Value]] = [{"state": state} for state in states]
    return [each.text for each in notices_of(*changes)]


RUNS, ENDS = "program plate.nc runs", "program plate.nc has ended"


@pytest.mark.parametrize(
    ("states", "expected"),
    [
        (("IDLE", "RUN", "IDLE"), [RUNS, ENDS]),
        (("IDLE", "WAIT", "HOLD", "PAUSED", "RUN", "RUN", "IDLE", "IDLE"), [RUNS, ENDS]),
        (("IDLE", "HOMING", "IDLE"), []),
        (("RUN", "HOMING", "RUN", "IDLE"), [RUNS, ENDS]),
        (("RUN", None, "RUN", None, "IDLE"), [RUNS, ENDS]),
        (("PAUSED", "ALARM", "IDLE"), [RUNS, "program plate.nc was ended by an alarm"]),
        (("ALARM", "IDLE"), []),
    ],
)
def test_a_program_begins_and_ends_once(states: tuple[str | None, ...], expected: object) -> None:
    assert texts(*states) == expected


def test_alarms_come_and_go_each_once() -> None:
    assert notices_of(
        {"alarms": (MILD,)}, {"alarms": (HARD, MILD, HARD)}, {"alarms": None}, {"alarms": (HARD,)}
    ) == [
        Notice("alarms", "34 X: drive is off", NOTE, MILD, True),
        Notice("alarms", "3 link lost", FAULT, HARD, True),
        Notice("alarms", "34 X: drive is off", NOTE, MILD, False),
    ]  # fmt: skip
    other = replace(HARD, text="link slow")
    found = notices_of({"alarms": (HARD,)}, {"alarms": (other,)})
    assert [(each.alarm, each.is_active) for each in found] == [
        (HARD, True), (other, True), (HARD, False),
    ]  # fmt: skip


def test_messages_and_the_loss_of_the_machine_are_noticed_when_they_change() -> None:
    found = notices_of(
        {"message": "DOOR"}, {"message": ""}, {"message": "DOOR / COOLANT"},
        {"available": False, "message": None}, {"available": False, "message": None},
        {"message": "DOOR / COOLANT"},
    )  # fmt: skip
    assert found == [
        Notice("message", "DOOR / COOLANT", NEWS),
        Notice("available", "the machine does not answer", FAULT),
        Notice("available", "the machine answers again", NEWS),
    ]
    assert notices_of({"available": False}) == []


def test_a_program_without_a_file_is_said() -> None:
    found = notices_of({"program": ""}, {"program": None, "state": "RUN"})
    assert [each.text for each in found] == ["program without a file runs"]
