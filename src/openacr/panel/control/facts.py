"""Facts in words for browsers: each is sent when it has changed."""

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from openacr.cnc.canonical import Spin
from openacr.cnc.interpreter.interpreter import Interpreter
from openacr.mill.card.alarms import Alarm
from openacr.mill.config.overrides import Override
from openacr.mill.config.settings import NONE
from openacr.mill.run.lifecycle import State
from openacr.mill.session import MillSession
from openacr.panel.control.machine.link import Link
from openacr.panel.control.operator.part import Part
from openacr.panel.control.operator.people import People
from openacr.sysvar.tabs import CELLS

Data = dict[str, Any]


class Facts:
    """The facts of one station by name, as they were sent last; some are those of one client."""

    def __init__(
        self,
        makers: Mapping[str, Callable[[], Data]],
        own: Mapping[str, Callable[[int], Data]],
        clients: Callable[[], Iterable[int]],
        tell: Callable[[Data], None],
    ) -> None:
        self._makers, self._own, self._clients, self._tell = makers, own, clients, tell
        self._reported: dict[str, Data] = {}
        self._reported_own: dict[tuple[str, int], Data] = {}

    def tell(self) -> None:
        """Tell the facts that have changed."""
        for name, make in self._makers.items():
            data = make()
            if self._reported.get(name) != data:
                self._reported[name] = data
                self._tell({"event": name, **data})
        own = {
            (name, client): make(client)
            for name, make in self._own.items()
            for client in self._clients()
        }
        for (name, client), data in own.items():
            if self._reported_own.get((name, client)) != data:
                self._tell({"event": name, **data, "to": client})
        self._reported_own = own

    def all(self) -> list[Data]:
        """The facts of all, for a browser that has just connected; its own are sent by `tell`."""
        self.tell()
        return [{"event": name, **data} for name, data in self._reported.items()]

    @property
    def reported(self) -> Mapping[str, Data]:
        """The facts as they were reported last; each is replaced as a whole. For any thread."""
        return self._reported


class MachineFacts:
    """What the screens are to know of the session of the machine."""

    def __init__(self, link: Link, part: Part, people: People) -> None:
        self._link, self._part, self._people = link, part, people

    @property
    def _lost(self) -> str:
        """Why there is no session; empty at a moment of the history, which is a mode."""
        return "" if self._link.is_away else self._link.lost

    def state(self) -> Data:
        """What the machine does and waits for."""
        session = self._link.session
        if session is None:
            return {
                "state": State.IDLE.name,
                "reason": self._lost,
                "busy": False,
                "running": False,
                "jogging": False,
                "options": self._options(),
                "asking": None,
                "tool_wanted": False,
                "mode": self._people.mode,
                "estop": {"wired": False, "on": False, "alarm": False},
                "link": "ok" if self._link.is_away else "lost",
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
            "options": self._options(),
            "asking": None if ask is None else {"text": ask.text, "parameter": ask.parameter},
            "tool_wanted": runner.entry_actions.changer.wants_confirmation,
            "mode": self._people.mode,
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

    def _options(self) -> Data:
        options = self._link.session.runner.options if self._link.session else None
        return {
            "dry": options.is_dry if options else False,
            "single": self._part.is_single,
            "skip": self._part.is_skipping,
            "optional": self._part.stops_optionally,
        }

    def modals(self) -> Data:
        """The codes and words in force."""
        return (
            modals(self._link.session, self._link.reading.work.run)
            if self._link.session
            else {"codes": []}
        )

    def alarms(self) -> Data:
        """Alarms that are active, and those that were."""
        if self._link.session is None:
            lost = {"code": 1, "text": self._lost, "effect": "REFUSE", "at_s": 0.0, "time": ""}
            return {"active": [lost] if self._lost else [], "history": [], "bars_start": True}
        alarms = self._link.session.runner.alarms
        return {
            "active": [alarm_data(each) for each in alarms.active],
            "history": [alarm_data(each) for each in alarms.history],
            "bars_start": alarms.bars_start or not self._link.session.is_set_up,
        }

    def messages(self) -> Data:
        """User messages that are shown."""
        shown = self._link.session.messages.shown if self._link.session else []
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

    def overrides(self) -> Data:
        """The three override switches."""
        if self._link.session is None:
            return {}
        runner = self._link.session.runner
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

    def home(self) -> Data:
        """How far homing is."""
        if self._link.session is None:
            return {"axes": []}
        settings = self._link.session.runner.settings
        return {
            "axes": [
                {
                    "name": axis.name,
                    "homed": settings.is_homed(axis.index),
                    "state": self._homing(self._link.session, axis.index),
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


def _is_in(session: MillSession, number: int) -> bool:
    """Whether an input was active when the card was polled last."""
    polled = session.machine.polled
    return polled is not None and session.runner.io.is_in(polled, number)


def alarm_data(alarm: Alarm) -> Data:
    """An alarm as the screens get it."""
    return {
        "code": alarm.kind.code,
        "text": alarm.text,
        "effect": alarm.kind.effect.name,
        "at_s": alarm.at_s,
        "time": alarm.time,
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
