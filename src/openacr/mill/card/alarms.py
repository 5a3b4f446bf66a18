"""Alarms of the machine: causes, texts, effects and acknowledgement.

An alarm stays active until its cause is gone and the operator has acknowledged it; an active
alarm bars START. Number, text and effect of each alarm are one row of the table here.
"""

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from datetime import datetime
from enum import Enum
from pathlib import Path

from openacr.errors import UserError

NO_ALARM = 0
MOST_KEPT = 100  # alarms of the history; the log has all


class Effect(Enum):
    """Effect of an alarm on the machine."""

    HOLD = "feed hold, the program is paused"
    ABORT = "the program ends as by ABORT"
    KILL = "all motion is killed, drives go off, the program ends"
    CUT_POWER = "as KILL; the drives of all axes of the card go off, all its programs end"
    REFUSE = "the start is refused"
    NONE = "nothing but the message"


@dataclass(frozen=True, slots=True)
class Kind:
    """One row of the alarm table."""

    code: int
    text: str  # {} is the axis, message or detail
    effect: Effect


_KINDS: dict[int, Kind] = {}


def _alarm(code: int, text: str, effect: Effect) -> Kind:
    if code in _KINDS:
        raise ValueError(f"alarm {code} is defined twice")
    _KINDS[code] = Kind(code, text, effect)
    return _KINDS[code]


NO_CARD = _alarm(1, "NO CARD FOUND ({})", Effect.REFUSE)
OLD_FIRMWARE = _alarm(2, "Firmware older than 1.18: {}", Effect.REFUSE)
LINK_LOST = _alarm(3, "Link lost", Effect.ABORT)
LACKS_FUNCTION = _alarm(4, "Card model lacks function: {}", Effect.REFUSE)
HOST_LOST = _alarm(5, "Watchdog of the card stopped the machine: its host was lost", Effect.ABORT)
WATCHDOG_HALTED = _alarm(6, "Watchdog of the card was halted", Effect.ABORT)
HOST_AWAY = _alarm(7, "Host did not watch the machine for {} s", Effect.HOLD)
NOT_OWNER = _alarm(8, "Another program has taken the machine", Effect.REFUSE)
SCREEN_STOP = _alarm(9, "Stopped at a screen: {}", Effect.CUT_POWER)
EMERGENCY_STOP = _alarm(10, "Emergency stop", Effect.CUT_POWER)
EXCESS_ERROR = _alarm(11, "Excess following error axis {}", Effect.KILL)
DRIVE_FAULT = _alarm(12, "Drive fault axis {}", Effect.KILL)
HARDWARE_LIMIT = _alarm(13, "Hardware limit axis {}", Effect.KILL)
MOVES_KILLED = _alarm(14, "Card killed moves", Effect.ABORT)
NO_REST = _alarm(15, "Machine does not come to rest: drives are switched off", Effect.CUT_POWER)
NOT_IN_PLACE = _alarm(16, "Machine was moved by another program: {}", Effect.ABORT)
CARD_RESET = _alarm(17, "Card was reset: its axes have lost their positions", Effect.ABORT)
NOT_MOVED = _alarm(18, "Card does not make the moves it was sent", Effect.ABORT)
CONTROL_FAILED = _alarm(19, "Control of the machine has failed: {}", Effect.ABORT)
SOFT_LIMIT = _alarm(20, "Soft limit axis {}", Effect.HOLD)
TARGET_BEYOND = _alarm(21, "Target beyond soft limit: {}", Effect.ABORT)
LIMIT_CROSSED = _alarm(22, "Card stopped axis {} beyond its soft limit", Effect.ABORT)
NOT_IN_POSITION = _alarm(24, "In-position time-out", Effect.ABORT)
NOT_CONFIRMED = _alarm(31, "Reference point not confirmed", Effect.ABORT)
POINT_MISSED = _alarm(32, "Reference point missed: {}", Effect.ABORT)
NOT_HOMED = _alarm(33, "Axis {} not homed", Effect.ABORT)
HOMING_FAILED = _alarm(34, "Homing failed axis {}", Effect.ABORT)
PROBE_ACTIVE = _alarm(35, "Probe already active", Effect.ABORT)
PROBE_IDLE = _alarm(37, "Probe not in contact", Effect.ABORT)
PROBE_MISSED = _alarm(36, "Probe captured nothing but its input changed", Effect.ABORT)
SPINDLE_EXCEPTION = _alarm(41, "Spindle exception", Effect.ABORT)
SPINDLE_TIME_OUT = _alarm(42, "Spindle time-out", Effect.ABORT)
LUBRICATION = _alarm(43, "Lubrication error", Effect.HOLD)
USER_MESSAGE = _alarm(50, "User message {}", Effect.NONE)
TOOL_TIME_OUT = _alarm(51, "Tool change time-out", Effect.ABORT)
PROGRAM_ERROR = _alarm(60, "Program error: {}", Effect.ABORT)
ANSWER_MISSING = _alarm(61, "Answer missing: {}", Effect.ABORT)
ENDLESS_LOOP = _alarm(62, "Endless loop", Effect.ABORT)
STORE_FAILED = _alarm(63, "Store not writable: {}", Effect.HOLD)


def kind(code: int) -> Kind:
    """The row of an alarm code."""
    return _KINDS[code]


class AlarmError(UserError):
    """Failure of an action; the runner raises the alarm and applies its effect."""

    def __init__(self, what: Kind, detail: object = "") -> None:
        super().__init__(f"alarm {what.code}: {what.text.format(detail)}")
        self.kind = what
        self.detail = str(detail)


def _now() -> str:
    return datetime.now().astimezone().isoformat(timespec="seconds")


@dataclass(frozen=True, slots=True)
class Alarm:
    """One alarm as it was raised."""

    kind: Kind
    detail: str
    at_s: float  # card time
    time: str = field(default_factory=_now, compare=False)  # of day, with the zone

    @property
    def text(self) -> str:
        """The text for the operator."""
        return self.kind.text.format(self.detail)


class Alarms:
    """Active alarms, the last ones that were raised, and the log of all alarms."""

    def __init__(self, log: Path | None = None) -> None:
        self.history: deque[Alarm] = deque(maxlen=MOST_KEPT)
        self.raised = 0  # alarms so far, those that are not kept included
        self._active: dict[tuple[int, str], Alarm] = {}
        self._log = log

    def raise_alarm(self, what: Kind, detail: object, at_s: float) -> Alarm:
        """Raise an alarm; one that is active already stays as it is."""
        key = (what.code, str(detail))
        if key not in self._active:
            alarm = self._active[key] = Alarm(what, str(detail), at_s)
            self.history.append(alarm)
            self.raised += 1
            self._note(alarm)
        return self._active[key]

    def is_active(self, what: Kind, detail: object) -> bool:
        """Whether this alarm is active."""
        return (what.code, str(detail)) in self._active

    @property
    def active(self) -> list[Alarm]:
        """The active alarms, oldest first."""
        return list(self._active.values())

    def since(self, raised: int) -> list[Alarm]:
        """The kept alarms that came after the first `raised` ones, oldest first."""
        count = min(self.raised - raised, len(self.history))
        return list(self.history)[len(self.history) - count :]

    @property
    def last_code(self) -> int:
        """The code of the latest alarm, 0 before the first."""
        return self.history[-1].kind.code if self.history else NO_ALARM

    @property
    def bars_start(self) -> bool:
        """Whether an active alarm bars a start."""
        return any(alarm.kind.effect is not Effect.NONE for alarm in self._active.values())

    def error(self, what: Kind, at_s: float) -> AlarmError:
        """Raise an alarm, and return the error that reports it."""
        self.raise_alarm(what, "", at_s)
        return AlarmError(what)

    def require_none(self) -> None:
        """Raise AlarmError while an active alarm bars a start."""
        if self.bars_start:
            raise AlarmError(self.active[0].kind, self.active[0].detail)

    def acknowledge(self, is_gone: Callable[[Alarm], bool]) -> list[Alarm]:
        """Clear every alarm whose cause is gone; returns those that stay."""
        self._active = {key: one for key, one in self._active.items() if not is_gone(one)}
        return self.active

    def _note(self, alarm: Alarm) -> None:
        if self._log is None:
            return
        try:
            with self._log.open("a", encoding="utf-8") as log:
                log.write(f"{alarm.time}  alarm {alarm.kind.code}  {alarm.text}\n")
        except OSError:
            self._log = None  # a full disk must not stop what an alarm has to do
