"""The state of a bus as people and other programs are shown it: plain data, ready for JSON."""

from typing import TypedDict

from openacr.fieldbus.ethercat.master.master import Master
from openacr.fieldbus.ethercat.wire.registers import State, al_text


class DeviceReport(TypedDict):
    """A device in the order of the cable; `state` is "" while it does not answer."""

    position: int
    name: str
    state: str
    code: int
    text: str


class DriveReport(TypedDict):
    """A drive: `state` by its name in CiA 402, positions in counts of the drive."""

    axis: str
    number: int
    position: int
    state: str
    mode: int
    actual: int
    target: int
    is_enabled: bool
    code: int
    group: int
    text: str
    alarm: str


class Counters(TypedDict):
    """Frames of the exchange: sent, lost, with a wrong working counter, sent late."""

    sent: int
    lost: int
    wrong: int
    late: int


class TimesReport(TypedDict):
    """Times of many periods: half are below the median, all but 1 in 10,000 below `most_s`."""

    median_s: float
    most_s: float
    worst_s: float


class LoopReport(TypedDict):
    """How a real-time loop has kept time: ticks, periods without one, lateness, computing."""

    period_s: float
    cycles: int
    missed: int
    lost_s: float
    late: TimesReport
    computing: TimesReport


class BusReport(TypedDict):
    """All of a bus; `alarm` is what has stopped all drives, `loop` is of a real-time loop."""

    interface: str
    is_real: bool
    is_coming_up: bool
    alarm: str
    cycle_s: float
    counters: Counters
    devices: list[DeviceReport]
    drives: list[DriveReport]
    loop: LoopReport | None


def devices_of(master: Master) -> list[DeviceReport]:
    """All devices, which have just been brought into their states."""
    return [
        {
            "position": device.position,
            "name": device.description.name or device.description.order,
            "state": "OP" if device in master.members_devices else "PREOP",
            "code": 0,
            "text": "",
        }
        for device in master.devices
    ]


def note_state(shown: DeviceReport, heard: tuple[State, int] | None) -> None:
    """Show the state of a device and the code of its error; None: it has not answered."""
    state, code = ("", 0) if heard is None else (heard[0].name, heard[1])
    shown["state"], shown["code"] = state, code
    shown["text"] = al_text(code) if code else ""
