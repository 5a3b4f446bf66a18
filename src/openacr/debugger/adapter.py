"""The Debug Adapter Protocol; `answers` has a function for each request.

Threads are the owners of lines of the target, counted from 1: programs (1-16) and PLCs (17-24) of
a card, or the part program (1). https://microsoft.github.io/debug-adapter-protocol/specification
"""

from __future__ import annotations

from collections.abc import Callable
from hmac import compare_digest
from itertools import count
from typing import Any

import msgspec

from openacr.client.program_variables import Value
from openacr.debugger import requests
from openacr.debugger.breakpoints import Fault, LineBreakpoint
from openacr.debugger.stops import Reason, Stop
from openacr.debugger.target import Target
from openacr.errors import OpenacrError, UserError
from openacr.plant.describe.explaining import explain
from openacr.plant.describe.toml_file import complaint_of

Json = dict[str, Any]
Handler = Callable[["Adapter", Any], Json | None]

_HANDLERS: dict[str, tuple[type[requests.Arguments], Handler]] = {}

CAPABILITIES = {
    "supportsConfigurationDoneRequest": True,
    "supportsConditionalBreakpoints": True,
    "supportsHitConditionalBreakpoints": True,
    "supportsLogPoints": True,
    "supportsDataBreakpoints": True,
    "supportsStepBack": True,
    "supportsSteppingGranularity": True,
    "supportsEvaluateForHovers": True,
    "supportsSetVariable": True,
    "supportsSetExpression": True,
    "supportsExceptionInfoRequest": True,
    "supportsBreakpointLocationsRequest": True,
    "supportsTerminateRequest": True,
    "exceptionBreakpointFilters": [
        {"filter": Fault.PROGRAM, "label": "Errors that end a program", "default": True},
        {"filter": Fault.KILL, "label": "Killed motion of a master", "default": True},
    ],
}


def request(form: type[requests.Arguments]) -> Callable[[Handler], Handler]:
    """Make a function the handler of the request of its name, with arguments of a type."""

    def registered(handler: Handler) -> Handler:
        words = handler.__name__.split("_")
        _HANDLERS[words[0] + "".join(map(str.title, words[1:]))] = form, handler
        return handler

    return registered


def _wrong(message: str, arguments: object, form: type) -> str:
    """What is wrong with the arguments of a request: name, value and what is allowed."""
    if not isinstance(arguments, dict) or not complaint_of(message)[1]:
        return message
    return explain(message, arguments, form).text


class Adapter:
    """Answers the requests of one client, and reports events by `send`."""

    def __init__(self, send: Callable[[Json], None], secret: str = "") -> None:
        self._send = send
        self._secret = secret  # a launch has to bring it
        self._is_begun = False  # `initialize` was answered
        self._sequence = 0
        self._target: Target | None = None
        self.is_running = False
        self.is_ended = False
        self.speed = 1.0  # 0: as fast as it goes
        self.is_stopped_at_entry = False
        self._held: dict[int, tuple[int, tuple[Value, ...]]] = {}  # by variables reference
        self._references = count(1)
        self.stop: Stop | None = None
        self._breakpoints: dict[str, list[LineBreakpoint]] = {}

    @property
    def is_watching(self) -> bool:
        """Whether `advance` is to be called: something runs."""
        return self.is_running or (self._target is not None and self._target.course.is_live)

    @property
    def target(self) -> Target:
        """What is debugged; UserError before there is one."""
        if self._target is None:
            raise UserError("no card is debugged yet: launch one")
        return self._target

    # messages

    def take(self, message: Json) -> None:
        """Answer a message of the client; nothing it contains ends the adapter."""
        if message.get("type") != "request":
            return
        command = message.get("command")
        answer: Json = {
            "type": "response", "request_seq": message.get("seq", 0), "command": command,
            "success": True,
        }  # fmt: skip
        try:
            body = self._answer(command, message.get("arguments") or {})
            if body is not None:
                answer["body"] = body
        except OpenacrError as error:
            answer |= {"success": False, "message": str(error)}
            answer["body"] = {"error": {"id": 1, "format": str(error), "showUser": True}}
        self._put(answer)
        if command == "initialize" and answer["success"]:
            self._is_begun = True
            self.event("initialized")

    def _answer(self, command: object, arguments: object) -> Json | None:
        found = _HANDLERS.get(command) if isinstance(command, str) else None
        if found is None:
            raise UserError(f"{command}: this debugger has no such request")
        if not self._is_begun and command != "initialize":
            raise UserError(f"{command}: a session begins with initialize")
        form, handler = found
        try:
            read = msgspec.convert(arguments, form)
        except msgspec.ValidationError as error:
            raise UserError(f"{command}: {_wrong(str(error), arguments, form)}") from None
        if isinstance(read, requests.Launch) and not compare_digest(read.secret, self._secret):
            raise UserError(
                'launch: "secret" is not the one that `openacr debug --port` has printed'
            )
        return handler(self, read)

    def event(self, name: str, **body: object) -> None:
        """Report an event."""
        self._put({"type": "event", "event": name, "body": body})

    def _put(self, message: Json) -> None:
        self._sequence += 1
        self._send({"seq": self._sequence} | message)

    def show(self, text: str, category: str = "console") -> None:
        """Show a text to the user."""
        self.event("output", category=category, output=text)

    # running

    def begin(self, target: Target) -> None:
        """Debug this from now on."""
        self._target = target
        target.course.listen(lambda text: self.show(text, "stdout"))
        if target.capabilities:
            self.event("capabilities", capabilities=dict(target.capabilities))

    def close(self) -> None:
        """End what is debugged, if there is anything."""
        target, self._target = self._target, None
        if target is not None:
            target.close()

    def resume(self, owner: int | None = None) -> None:
        """Let it run until `advance` finds a reason to stop."""
        self._forget(owner)
        self.is_running = True

    def _forget(self, owner: int | None) -> None:
        """Values of an earlier stop are void: of one program, where the others do not stop."""
        if owner is None or not self.target.course.is_live:
            self._held.clear()
        self._held = {n: held for n, held in self._held.items() if held[0] != owner}

    def advance(self, ticks: int) -> None:
        """Let time pass; called again and again by the server."""
        try:
            stop = self.target.course.run(ticks)
        except OpenacrError as error:  # of a journal that does not fit
            stop = Stop(Reason.EXCEPTION, None, str(error))
        text = self.target.heard()
        if text:
            self.show(text)
        if stop is not None:
            self.stopped(stop)

    def stopped(self, stop: Stop) -> None:
        """Report that the card stands."""
        self.is_running = False
        self.stop = stop
        self._forget(stop.program)
        owner = self.target.owners()[0][0] if stop.program is None else stop.program
        self.event(
            "stopped",
            reason=stop.reason.value,
            threadId=owner + 1,
            allThreadsStopped=not self.target.course.is_live,
            **({"description": stop.text, "text": stop.text} if stop.text else {}),
        )

    def keep(self, owner: int, elements: tuple[Value, ...]) -> int:
        """A reference to values of a program until the card runs again; 0 for none."""
        if not elements:
            return 0
        reference = next(self._references)
        self._held[reference] = owner, elements
        return reference

    def held(self, reference: int) -> tuple[int, tuple[Value, ...]]:
        """The program and the values that a reference means."""
        if reference not in self._held:
            raise UserError("these values are of an earlier stop")
        return self._held[reference]

    def standing(self) -> Target:
        """What is debugged, which must stand; UserError while it runs."""
        if self.is_running and not self.target.course.is_live:
            raise UserError("the card runs: pause it first")
        return self.target

    def set_breakpoints_of(self, source: str, breakpoints: list[LineBreakpoint]) -> None:
        """Replace the breakpoints of a file or listing."""
        self._breakpoints[source] = breakpoints
        every = [each for found in self._breakpoints.values() for each in found]
        self.target.course.set_lines(every)
