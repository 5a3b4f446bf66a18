"""The table of values: a row here appears in every system.

A row says what a value is called, what it means, its unit and kind, how it is read, and under
which standard type MTConnect and OPC UA know it. Lengths are in mm, speeds in mm/s and angles in
degrees, whatever the unit of the machine.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from math import isnan
from typing import Any

from openacr.bridge.moment import S_PER_MIN, Moment
from openacr.bridge.tools import CuttingTool, cutting_tools
from openacr.mill.run.lifecycle import State
from openacr.panel.control.machine.snapshot import Light, Snapshot


class Unit(StrEnum):
    """Units; the texts are those of MTConnect."""

    NONE = ""
    MM = "MILLIMETER"
    MM_PER_S = "MILLIMETER/SECOND"
    DEGREE = "DEGREE"
    RPM = "REVOLUTION/MINUTE"
    PERCENT = "PERCENT"
    SECOND = "SECOND"


class Kind(StrEnum):
    """What a value is."""

    NUMBER = "number"
    COUNT = "count"
    SWITCH = "switch"
    TEXT = "text"
    WORD = "word"  # one of few, in capitals
    ALARMS = "alarms"
    TOOLS = "tools"


MILD = frozenset({"REFUSE", "NONE"})  # effects of alarms that stop nothing


@dataclass(frozen=True, slots=True)
class Alarm:
    """An active alarm."""

    code: int
    text: str
    effect: str  # REFUSE, HALT ...: what the machine does while it is active

    def __str__(self) -> str:
        return f"{self.code} {self.text}"

    @property
    def is_mild(self) -> bool:
        """Whether it stops nothing that runs."""
        return self.effect in MILD

    @property
    def labels(self) -> tuple[str, str]:
        """Its number and its text."""
        return str(self.code), self.text


Rows = tuple[Alarm, ...] | tuple[CuttingTool, ...]
Value = float | int | bool | str | Rows | None  # None: not known now


def alarms_of(value: Value) -> tuple[Alarm, ...]:
    """The alarms in a value; none where it is not known."""
    found = value if isinstance(value, tuple) else ()
    return tuple(each for each in found if isinstance(each, Alarm))


@dataclass(frozen=True, slots=True)
class Standard:
    """The name of a value in MTConnect (type, subType, category)."""

    type: str
    sub: str = ""
    is_event: bool = False


@dataclass(frozen=True, slots=True)
class Row:
    """One value of the machine, or one of each axis."""

    name: str
    meaning: str
    kind: Kind
    read: Callable[[Moment, int], Value]
    unit: Unit = Unit.NONE
    standard: Standard | None = None


# --- reading --------------------------------------------------------------------------


def _run(value: Callable[[Snapshot], Value]) -> Callable[[Moment, int], Value]:
    """A value of the CNC side: not known on a card alone, nor while the machine is lost."""

    def read(moment: Moment, _axis: int) -> Value:
        found = value(moment.run) if moment.run is not None and not moment.lost else None
        return None if isinstance(found, float) and isnan(found) else found

    return read


def _light(light: Light) -> Callable[[Moment, int], Value]:
    return _run(lambda run: bool(run.lights & light))


def _fact(kind: type, name: str, *keys: str) -> Callable[[Moment, int], Value]:
    def read(moment: Moment, _axis: int) -> Value:
        found = moment.fact(name, *keys)
        return None if moment.lost or found is None else kind(found)

    return read


def _speed(value: Callable[[Snapshot], float]) -> Callable[[Moment, int], Value]:
    """A feed in units/min, as mm/s."""

    def read(moment: Moment, _axis: int) -> Value:
        if moment.run is None or moment.lost:
            return None
        return value(moment.run) * moment.mm_per_unit / S_PER_MIN

    return read


def _path_speed(moment: Moment, _axis: int) -> Value:
    known = moment.speed_ups is not None and not moment.lost
    return moment.speed_ups * moment.mm_per_unit if known and moment.speed_ups is not None else None


def _column(values: Callable[[Moment], tuple[float, ...]]) -> Callable[[Moment, int], Value]:
    """A value of each axis in units of the machine; `Item.read` makes mm of it."""

    def read(moment: Moment, axis: int) -> Value:
        column = values(moment)
        if moment.lost or axis >= len(column) or isnan(column[axis]):
            return None
        return column[axis]

    return read


def _bit(mask: Callable[[Snapshot], int]) -> Callable[[Moment, int], Value]:
    def read(moment: Moment, axis: int) -> Value:
        run = moment.run
        return None if run is None or moment.lost else bool(mask(run) >> axis & 1)

    return read


EXECUTIONS = {
    State.IDLE: "READY",
    State.RUN: "ACTIVE",
    State.WAIT: "WAIT",
    State.HOMING: "ACTIVE",
    State.PAUSED: "FEED_HOLD",
    State.HOLD: "PROGRAM_STOPPED",
    State.ALARM: "STOPPED",
}
MODES = {"auto": "AUTOMATIC", "manual": "MANUAL", "mdi": "MANUAL_DATA_INPUT", "home": "MANUAL"}


def _mode(moment: Moment, _axis: int) -> Value:
    """Set-up and diagnosis are hand modes: no program starts in them."""
    mode = moment.fact("state", "mode")
    return None if mode is None or moment.lost else MODES.get(mode, "MANUAL")


def _emergency(moment: Moment, _axis: int) -> Value:
    stop = moment.fact("state", "estop")
    if stop is None or moment.lost:
        return None
    return "TRIGGERED" if stop["on"] or stop["alarm"] else "ARMED"


def _alarms(moment: Moment, _axis: int) -> Value:
    active = moment.fact("alarms", "active")
    if active is None:
        return None
    return tuple(Alarm(each["code"], each["text"], each["effect"]) for each in active)


def _messages(moment: Moment, _axis: int) -> Value:
    shown = moment.fact("messages", "shown")
    if shown is None or moment.lost:
        return None
    return " / ".join(str(each["text"]) for each in shown)


def _bus(value: Callable[[Mapping[str, Any]], Value]) -> Callable[[Moment, int], Value]:
    """A value of the bus of the machine: not known where none is open."""
    return lambda moment, _axis: None if moment.bus is None else value(moment.bus)


def _frames(name: str) -> Callable[[Moment, int], Value]:
    return _bus(lambda bus: int(bus["counters"][name]))


def _loop(*names: str, scale: float = 1.0) -> Callable[[Moment, int], Value]:
    """A figure of the real-time loop of the bus: not known where the card has none."""

    def read(bus: Mapping[str, Any]) -> Value:
        found: Any = bus.get("loop")
        for name in names if found is not None else ():
            found = found[name]
        return None if found is None else found if scale == 1.0 else scale * found

    return _bus(read)


def _program(moment: Moment, _axis: int) -> Value:
    """The loaded program; empty where a reachable machine has loaded no program."""
    if moment.lost or moment.fact("program") is None:
        return None
    return str(moment.fact("program", "loaded", "path") or "")


N, C, S, T, W = Kind.NUMBER, Kind.COUNT, Kind.SWITCH, Kind.TEXT, Kind.WORD

ROWS = (
    Row("available", "the machine answers", S, lambda m, _: not m.lost,
        standard=Standard("AVAILABILITY")),
    Row("execution", "what the execution of the program does", W,
        _run(lambda run: EXECUTIONS[run.state]), standard=Standard("EXECUTION")),
    Row("mode", "mode of the control", W, _mode, standard=Standard("CONTROLLER_MODE")),
    Row("emergency_stop", "emergency stop: ARMED or TRIGGERED", W, _emergency,
        standard=Standard("EMERGENCY_STOP")),
    Row("state", "state of the run", W, _run(lambda run: run.state.name)),
    Row("program", "path of the loaded program", T, _program, standard=Standard("PROGRAM")),
    Row("line", "executing line of the program", C, _run(lambda run: run.line),
        standard=Standard("LINE_NUMBER", "ABSOLUTE")),
    Row("block", "text of the executing block", T, _fact(str, "program", "text"),
        standard=Standard("BLOCK")),
    Row("work_system", "work coordinate system", W, _fact(str, "modals", "work"),
        standard=Standard("WORK_OFFSET")),
    Row("tool", "tool in the spindle", C, _run(lambda run: run.tool),
        standard=Standard("TOOL_NUMBER")),
    Row("tools", "tools of the tool table", Kind.TOOLS, lambda m, _: cutting_tools(m),
        standard=Standard("ASSET_CHANGED")),
    Row("parts", "finished parts", C, _run(lambda run: int(run.parts)),
        standard=Standard("PART_COUNT", "ALL")),
    Row("run_time", "time the program has run", N, _run(lambda run: run.run_s), Unit.SECOND,
        Standard("PROCESS_TIMER", "PROCESS")),
    Row("time_left", "predicted time to the end of the program", N, _run(lambda run: run.left_s),
        Unit.SECOND),
    Row("moving", "axes move", S,
        lambda m, _: None if m.lost or m.is_moving is None else m.is_moving),
    Row("path_speed", "speed along the path", N, _path_speed, Unit.MM_PER_S,
        Standard("PATH_FEEDRATE", "ACTUAL")),
    Row("feed", "programmed feed", N, _speed(lambda run: run.feed_upm), Unit.MM_PER_S,
        Standard("PATH_FEEDRATE", "PROGRAMMED")),
    Row("feed_override", "override of feeds", N, _run(lambda run: run.feed_percent), Unit.PERCENT,
        Standard("PATH_FEEDRATE_OVERRIDE", "PROGRAMMED", is_event=True)),
    Row("rapid_override", "override of rapids", N, _run(lambda run: run.rapid_percent),
        Unit.PERCENT, Standard("PATH_FEEDRATE_OVERRIDE", "RAPID", is_event=True)),
    Row("spindle_speed", "programmed speed of the running spindle, 0 while it is off", N,
        _run(lambda run: run.spindle_rpm), Unit.RPM, Standard("ROTARY_VELOCITY", "PROGRAMMED")),
    Row("spindle_override", "override of the spindle", N, _run(lambda run: run.spindle_percent),
        Unit.PERCENT, Standard("ROTARY_VELOCITY_OVERRIDE", is_event=True)),
    Row("spindle_on", "the spindle is on", S, _light(Light.SPINDLE)),
    Row("flood", "flood coolant is on", S, _light(Light.FLOOD)),
    Row("mist", "mist coolant is on", S, _light(Light.MIST)),
    Row("dry_run", "the program runs dry", S, _light(Light.DRY)),
    Row("single_block", "single block", S, _light(Light.SINGLE)),
    Row("barred", "alarms bar the start", S, _light(Light.BARRED)),
    Row("message", "messages that are shown", T, _messages, standard=Standard("MESSAGE")),
    Row("bus_stopped", "all drives on the bus are stopped", S,
        _bus(lambda bus: bool(bus["alarm"]))),
    Row("bus_alarm", "why all drives on the bus are stopped", T, _bus(lambda bus: bus["alarm"])),
    Row("bus_frames_sent", "frames sent on the bus", C, _frames("sent")),
    Row("bus_frames_lost", "frames of the bus that were lost", C, _frames("lost")),
    Row("bus_frames_wrong", "frames of the bus with a wrong working counter", C, _frames("wrong")),
    Row("bus_frames_late", "frames sent late on the bus", C, _frames("late")),
    Row("loop_cycles", "ticks of the real-time loop", C, _loop("cycles")),
    Row("loop_missed", "periods in which the real-time loop began no tick", C, _loop("missed")),
    Row("loop_late_us", "lateness that 99.99 % of the ticks of the loop keep, microseconds", N,
        _loop("late", "most_s", scale=1e6)),
    Row("loop_worst_late_us", "worst lateness of a tick of the loop, microseconds", N,
        _loop("late", "worst_s", scale=1e6)),
    Row("loop_worst_work_us", "longest computation of a tick of the loop, microseconds", N,
        _loop("computing", "worst_s", scale=1e6)),
    Row("alarms", "active alarms", Kind.ALARMS, _alarms, standard=Standard("SYSTEM")),
)  # fmt: skip

AXIS_ROWS = (
    Row("actual", "actual position, machine coordinates", N, _column(lambda m: m.actual), Unit.MM,
        Standard("POSITION", "ACTUAL")),
    Row("commanded", "commanded position, machine coordinates", N, _column(lambda m: m.commanded),
        Unit.MM, Standard("POSITION", "COMMANDED")),
    Row("following_error", "following error", N, _column(lambda m: m.following), Unit.MM),
    Row("work", "commanded position, program coordinates", N,
        _column(lambda m: m.run.work if m.run is not None else ()), Unit.MM),
    Row("to_go", "distance to go of the executing move", N,
        _column(lambda m: m.run.to_go if m.run is not None else ()), Unit.MM),
    Row("homed", "the axis is homed", S, _bit(lambda run: run.homed)),
    Row("jogging", "the axis is jogged", S, _bit(lambda run: run.jogging)),
)  # fmt: skip
