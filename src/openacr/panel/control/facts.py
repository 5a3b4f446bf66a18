"""Facts in words for browsers: each is sent when it has changed."""

from collections.abc import Callable, Mapping
from typing import Any

from openacr.cnc.canonical import Spin
from openacr.cnc.interpreter.interpreter import Interpreter
from openacr.mill.card.alarms import Alarm
from openacr.mill.config.overrides import Override
from openacr.mill.config.settings import NONE
from openacr.mill.run.lifecycle import State
from openacr.mill.session import MillSession
from openacr.panel.control.about import machine_data
from openacr.panel.control.history import moment_data, timeline_data
from openacr.panel.control.lamp import Lamp
from openacr.panel.control.part import Part
from openacr.panel.control.shared import Shared
from openacr.panel.control.stopping import Stopping
from openacr.panel.control.times import NOT_HERE, Times
from openacr.panel.control.typed import Typed
from openacr.sysvar.tabs import CELLS

Data = dict[str, Any]


class Facts:
    """The facts of one station, as they were sent last."""

    def __init__(
        self,
        station: Shared,
        part: Part,
        typed: Typed,
        times: Times,
        of_card: tuple[Stopping, Lamp],
    ) -> None:
        self._station, self._part, self._typed, self._times = station, part, typed, times
        self._stopping, self._lamp = of_card
        self._reported: dict[str, Data] = {}

    def tell(self) -> None:
        """Tell the facts that have changed."""
        for name, make in MAKERS.items():
            data = make(self, self._station)
            if self._reported.get(name) != data:
                self._reported[name] = data
                self._station.tell({"event": name, **data})

    def all(self) -> list[Data]:
        """All facts, for a browser that has just connected."""
        self.tell()
        return [{"event": name, **data} for name, data in self._reported.items()]

    @property
    def reported(self) -> Mapping[str, Data]:
        """The facts by name, as they were reported last; each is replaced as a whole."""
        return self._reported

    # --- facts ------------------------------------------------------------------------

    def state(self, station: Shared) -> Data:
        """What the machine does and waits for."""
        session = station.session
        if session is None:
            return {
                "state": State.IDLE.name,
                "reason": "" if self._times.is_away else station.lost,
                "busy": False,
                "running": False,
                "jogging": False,
                "options": self._options(station),
                "asking": None,
                "tool_wanted": False,
                "mode": station.mode,
                "estop": {"wired": False, "on": False, "alarm": False},
                "link": "ok" if self._times.is_away else "lost",
                "passes": 0,
                "parts": 0,
                "homed": [],
                "aborted": False,
                "can": {},
            }
        runner = session.runner
        ask = runner.asking
        settings = runner.settings
        codes = {alarm.kind.code for alarm in runner.alarms.active}
        return {
            "state": runner.state.name,
            "reason": runner.reason,
            "busy": runner.is_busy,
            "running": self._part.executing.is_under_way,
            "jogging": runner.jogging.is_active,
            "options": self._options(station),
            "asking": None if ask is None else {"text": ask.text, "parameter": ask.parameter},
            "tool_wanted": runner.entry_actions.changer.wants_confirmation,
            "mode": station.mode,
            "estop": {
                "wired": settings.wiring.emergency_stop != NONE,
                "on": _is_in(session, settings.wiring.emergency_stop),
                "alarm": 10 in codes,
            },
            "link": "lost" if 3 in codes or runner.is_out_of_reach else "ok",
            "passes": runner.passes,
            "parts": int(session.cells.read(CELLS.parts_finished)),
            "homed": [axis.name for axis in settings.axes if settings.is_homed(axis.index)],
            "aborted": runner.was_aborted,
            "can": {"run.begin": self._part.bar if runner.state is State.IDLE else ""},
        }

    def _options(self, station: Shared) -> Data:
        options = station.session.runner.options if station.session else None
        return {
            "dry": options.is_dry if options else False,
            "single": self._part.is_single,
            "skip": self._part.is_skipping,
            "optional": self._part.stops_optionally,
        }

    def stopped(self, _station: Shared) -> Data:
        """What the last STOP has found on the card, and what moves in spite of it."""
        return self._stopping.data()

    def lamp(self, _station: Shared) -> Data:
        """What moves and runs on the card, by any host."""
        return self._lamp.data()

    def program(self, station: Shared) -> Data:
        """The loaded program and its executing block."""
        return self._part.data()

    def modals(self, station: Shared) -> Data:
        """The codes and words in force."""
        return (
            modals(station.session, station.reading.work.run) if station.session else {"codes": []}
        )

    def alarms(self, station: Shared) -> Data:
        """Alarms that are active, and those that were."""
        if station.session is None:
            text = "" if self._times.is_away else station.lost  # a mode, no alarm
            lost = {"code": 1, "text": text, "effect": "REFUSE", "at_s": 0.0, "time": ""}
            return {"active": [lost] if text else [], "history": [], "bars_start": True}
        alarms = station.session.runner.alarms
        return {
            "active": [_alarm(each) for each in alarms.active],
            "history": [_alarm(each) for each in alarms.history],
            "bars_start": alarms.bars_start or not station.session.is_set_up,
        }

    def messages(self, station: Shared) -> Data:
        """User messages that are shown."""
        shown = station.session.messages.shown if station.session else []
        return {
            "shown": [
                {
                    "number": each.number,
                    "text": each.shown,
                    "color": each.text_color,
                    "back": each.back_color,
                    "alarm": each.is_alarm,
                }
                for each in shown
            ]
        }

    def control(self, station: Shared) -> Data:
        """Who has control."""
        return station.people.data()

    def overrides(self, station: Shared) -> Data:
        """The three override switches."""
        if station.session is None:
            return {}
        runner = station.session.runner
        names = {"feed": Override.FEED, "rapid": Override.RAPID, "spindle": Override.SPINDLE}
        return {
            name: {
                "click": runner.overrides.click(which),
                "percent": 100.0 * runner.overrides.factor(which),
                "wired": runner.settings.switch(which.value) != NONE,
                "table": list(runner.settings.table(which.value)),
            }
            for name, which in names.items()
        }

    def mdi(self, station: Shared) -> Data:
        """What was typed in MDI."""
        return self._typed.data()

    def home(self, station: Shared) -> Data:
        """How far homing is."""
        if station.session is None:
            return {"axes": []}
        settings = station.session.runner.settings
        return {
            "axes": [
                {
                    "name": axis.name,
                    "homed": settings.is_homed(axis.index),
                    "state": self._homing(station.session, axis.index),
                    "priority": settings.home(axis.index).priority,
                    "switch": settings.home(axis.index).switch_input,
                }
                for axis in settings.axes
            ]
        }

    def _homing(self, session: MillSession, axis: int) -> str:
        """What an axis waits for while it is homed; done or failed after it."""
        runner = session.runner
        state = runner.homing.get(axis, "")
        is_over = runner.state is not State.HOMING
        return "failed" if is_over and state not in ("", "done") else state

    def timeline(self, station: Shared) -> Data:
        """The branches and bookmarks of the history."""
        history = station.installation.history
        if history is None:
            return {"why": NOT_HERE}
        return {"why": "", **timeline_data(history, self._times.speed)}

    def moment(self, station: Shared) -> Data:
        """Where the card is in its history."""
        history = station.installation.history
        return {} if history is None else moment_data(history)

    def machine(self, station: Shared) -> Data:
        """What the machine is: card, unit, axes."""
        return machine_data(station.installation)


def _is_in(session: MillSession, number: int) -> bool:
    """Whether an input was active when the card was polled last."""
    polled = session.machine.polled
    return polled is not None and session.runner.io.is_in(polled, number)


def _alarm(alarm: Alarm) -> Data:
    return {
        "code": alarm.kind.code,
        "text": alarm.text,
        "effect": alarm.kind.effect.name,
        "at_s": alarm.at_s,
        "time": alarm.time,
    }


def _scope(_facts: Facts, station: Shared) -> Data:
    """The capture of the scope; its samples are frames."""
    capture = station.scope.capture
    if capture is None:
        return {"running": False}
    owner = station.people.person(capture.owner)
    return {**capture.data(), "owner": None if owner is None else owner.data()["name"]}


MAKERS: dict[str, Callable[[Facts, Shared], Data]] = {
    "machine": Facts.machine,
    "state": Facts.state,
    "stopped": Facts.stopped,
    "lamp": Facts.lamp,
    "program": Facts.program,
    "modals": Facts.modals,
    "alarms": Facts.alarms,
    "messages": Facts.messages,
    "control": Facts.control,
    "overrides": Facts.overrides,
    "mdi": Facts.mdi,
    "home": Facts.home,
    "scope": _scope,
    "timeline": Facts.timeline,
    "moment": Facts.moment,
}


def modals(session: MillSession, run: Interpreter) -> dict[str, Any]:
    """Codes and words in force in the block that is read."""
    modal, actions = run.modal, session.runner.entry_actions
    return {
        "codes": modal.codes,
        "F": modal.feed,
        "S": modal.speed,
        "T": modal.tool,
        "D": modal.radius_number,
        "H": modal.length_number,
        "spindle": actions.spindle.state,
        "coolant": actions.coolant.has_mist + 2 * actions.coolant.has_flood,
        "is_spinning": modal.spin is not Spin.OFF,
        "work": modal.work_code,
    }
