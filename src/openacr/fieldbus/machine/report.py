"""The state of a bus as people and other programs are shown it: plain data, ready for JSON."""

from typing import TypedDict


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


class BusReport(TypedDict):
    """All of a bus; `alarm` is what has stopped all drives."""

    interface: str
    is_real: bool
    is_coming_up: bool
    alarm: str
    cycle_s: float
    counters: Counters
    devices: list[DeviceReport]
    drives: list[DriveReport]
