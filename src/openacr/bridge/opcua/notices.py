"""What happens on a machine from one reading to the next: alarms, programs, messages, its loss."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from openacr.bridge.rows import Alarm, Value, alarms_of

Named = Mapping[str, Value]  # a reading by the names of values
RUNNING = frozenset({"RUN", "WAIT", "PAUSED", "HOLD"})  # states in which a program runs
ENDED = frozenset({"IDLE", "ALARM"})  # not HOMING: programs home axes, too
NAMES = ("available", "state", "program", "message", "alarms")
# Severities, 1 to 1000: news, what operators should see, what has stopped the machine.
NEWS, NOTE, FAULT = 100, 500, 800


@dataclass(frozen=True, slots=True)
class Notice:
    """Something that has happened, from the value with this name."""

    source: str
    text: str
    severity: int
    alarm: Alarm | None = None
    is_active: bool = False  # of the alarm


class Notices:
    """Finds what has happened since the last value that was known.

    Messages of the first reading are what there is, not what happens.
    """

    def __init__(self) -> None:
        self._last: Named = {}
        self._is_running = False

    def of(self, values: Named) -> list[Notice]:
        """What has happened since the last reading, alarms first."""
        known = {name: value for name, value in values.items() if value is not None}
        last, self._last = self._last, {**self._last, **known}
        found = [*_alarms(last, values), *self._programs(values)]
        if last:
            found += [*_messages(last, values), *_loss(last, values)]
        return found

    def _programs(self, values: Named) -> Iterator[Notice]:
        """Starts and ends of programs. While the state is unknown, the last known one counts."""
        state, name = values["state"], values["program"] or "without a file"
        if state in RUNNING and not self._is_running:
            self._is_running = True
            yield Notice("state", f"program {name} runs", NEWS)
        elif state in ENDED and self._is_running:
            self._is_running = False
            if state == "ALARM":
                yield Notice("state", f"program {name} was ended by an alarm", FAULT)
            else:
                yield Notice("state", f"program {name} has ended", NEWS)


def _alarms(last: Named, values: Named) -> Iterator[Notice]:
    """Alarms that have become active, and those that are no longer."""
    if values["alarms"] is None:
        return
    before, active = alarms_of(last.get("alarms")), alarms_of(values["alarms"])
    for alarms, others, is_active in ((active, before, True), (before, active, False)):
        for alarm in dict.fromkeys(alarms):
            if alarm not in others:
                severity = NOTE if alarm.is_mild else FAULT
                yield Notice("alarms", str(alarm), severity, alarm, is_active)


def _messages(last: Named, values: Named) -> Iterator[Notice]:
    text = values["message"]
    if isinstance(text, str) and text and text != last.get("message"):
        yield Notice("message", text, NEWS)


def _loss(last: Named, values: Named) -> Iterator[Notice]:
    if values["available"] != last["available"]:
        if values["available"]:
            yield Notice("available", "the machine answers again", NEWS)
        else:
            yield Notice("available", "the machine does not answer", FAULT)
