"""What the screens show of a running machine, as one immutable record per poll."""

from dataclasses import dataclass, field
from enum import IntFlag
from math import nan

from openacr.mill.run.lifecycle import State

STATES = tuple(State)  # their places are the numbers in frames
Axes = tuple[float, ...]


class Light(IntFlag):
    """Bits of a status frame."""

    BUSY = 1
    MOVING = 2
    DRY = 4
    SINGLE = 8
    BARRED = 16
    EMERGENCY = 32
    LINK_LOST = 64
    SKIP = 128
    OPTIONAL = 256
    SPINDLE = 512
    FLOOD = 1024
    MIST = 2048
    TOOL = 4096
    QUESTION = 8192
    HELD = 16384


@dataclass(frozen=True, slots=True, kw_only=True)
class Snapshot:
    """One look at the machine; lengths in default units, machine axes in their order."""

    number: int
    tick_ms: float  # card time; it never goes back, whatever the card does
    read_s: float  # when it was read, on the clock of the server
    state: State = State.IDLE
    lights: int = 0  # `Light`
    homed: int = 0
    jogging: int = 0
    near_limit: int = 0
    line: int = 0
    tool: int = 0
    feed_upm: float = 0.0
    speed_upm: float = 0.0
    spindle_rpm: float = 0.0
    feed_percent: float = 100.0
    rapid_percent: float = 100.0
    spindle_percent: float = 100.0
    run_s: float = 0.0
    left_s: float = nan
    parts: float = 0.0
    work: Axes = ()
    commanded: Axes = ()
    actual: Axes = ()
    following: Axes = ()
    to_go: Axes = ()
    following_end: Axes = field(default=())  # end of the next move, program coordinates


class Ticks:
    """When each of the last card ticks was read: the age of what a browser has drawn."""

    KEPT = 64

    def __init__(self) -> None:
        self._read_s: dict[float, float] = {}

    def note(self, tick_ms: float, read_s: float) -> None:
        """Note when a tick was read; one that stands still is as young as its last reading."""
        self._read_s.pop(tick_ms, None)
        self._read_s[tick_ms] = read_s
        if len(self._read_s) > self.KEPT:
            del self._read_s[next(iter(self._read_s))]

    def age_s(self, tick_ms: float, now_s: float) -> float | None:
        """The age of a tick; None for one that is unknown or long past."""
        read_s = self._read_s.get(tick_ms)
        return None if read_s is None else now_s - read_s
