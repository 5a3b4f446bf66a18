"""Machines and bridges for tests: a feed driven by hand, bridges on free ports."""

from collections.abc import Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from openacr.bridge.bridge import Bridge
from openacr.bridge.feed import Feed
from openacr.bridge.load import parse_bridge
from openacr.bridge.moment import AxisName, Moment
from openacr.bridge.systems import bridge_of
from openacr.errors import UserError
from openacr.mill.config.tools import Tip, Tool
from openacr.mill.run.lifecycle import State
from openacr.panel.control.machine.snapshot import Light, Snapshot

RUNNING = Moment(
    commanded=(1.0, 2.0, 90.0),
    actual=(1.5, -2.0, 90.25),
    following=(0.5, 0.0, 0.25),
    speed_ups=2.0,
    is_moving=True,
    run=Snapshot(
        number=7,
        tick_ms=1000.0,
        read_s=0.0,
        state=State.RUN,
        lights=Light.BUSY | Light.MOVING | Light.SPINDLE,
        homed=0b101,
        line=12,
        tool=3,
        feed_upm=120.0,
        spindle_rpm=900.0,
        feed_percent=80.0,
        run_s=12.5,
        parts=4.0,
        work=(11.0, 12.0, 90.0),
        to_go=(0.0, 1.0, 2.0),
    ),
    facts={
        "state": {"mode": "auto", "estop": {"wired": True, "on": False, "alarm": False}},
        "program": {"loaded": {"path": "plate.nc"}, "text": "G1 X1"},
        "modals": {"work": "G54"},
        "messages": {"shown": [{"text": "DOOR"}, {"text": "COOLANT LOW"}]},
        "alarms": {"active": [{"code": 34, "text": "X: drive is off", "effect": "REFUSE"}]},
    },
    tools=(Tool(3, 3.0, 50.25, Tip.FLAT), Tool(12, None, -7.5, Tip.BALL)),
    watched={12290: 400.0, 4096: 0b100},
)
VALUES = """
[[value]]
name = "pulses"
parameter = "axis0.actual position"
unit = "pulses"
meaning = "encoder of X"
write = true
low = -1000
high = 1000
[[value]]
name = "gate"
flag = 2
write = true
"""


class GivenFeed:
    """A machine that is what the test says."""

    def __init__(self, moment: Moment = RUNNING) -> None:
        self.moment = moment
        self.written: list[tuple[int, float, bool]] = []
        self.refusal = ""
        self.watched: list[int] = []
        self.axes: tuple[AxisName, ...] = (
            AxisName("X"), AxisName("Y"), AxisName("C", is_rotary=True),
        )  # fmt: skip

    def start(self, parameters: list[int], rate_hz: float) -> None:
        self.watched = parameters

    def newest(self) -> Moment:
        return self.moment

    def write(self, number: int, value: float, *, is_flag: bool) -> "Future[None]":
        done: Future[None] = Future()
        if self.refusal:
            done.set_exception(UserError(self.refusal))
            return done
        self.written.append((number, value, is_flag))
        done.set_result(None)
        return done

    def stop(self) -> None:
        """Nothing is read."""

    def lose(self, why: str = "the card does not answer") -> None:
        self.moment = replace(self.moment, lost=why)


def show_line(feed: GivenFeed, line: int) -> None:
    """Have the machine execute another line."""
    assert feed.moment.run is not None
    feed.moment = replace(feed.moment, run=replace(feed.moment.run, line=line))


@contextmanager
def bridged(text: str, feed: Feed, folder: Path = Path()) -> Iterator[Bridge]:
    """A bridge that runs."""
    bridge = bridge_of(parse_bridge(text), folder, feed)
    bridge.start()
    try:
        yield bridge
    finally:
        bridge.stop()


def url(bridge: Bridge, name: str) -> str:
    """Where a system is."""
    return next(p.split(" ", 1)[1] for p in bridge.places if p.startswith(f"{name} "))
