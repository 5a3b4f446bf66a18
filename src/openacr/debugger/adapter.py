"""The Debug Adapter Protocol for a virtual card: one function for each request.

Threads are programs (1-16) and PLCs (17-24). Only programs step; a PLC steps servo interrupt by
servo interrupt. https://microsoft.github.io/debug-adapter-protocol/specification
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import msgspec

from openacr.debugger import questions, requests
from openacr.debugger.breakpoints import DataBreakpoint, Fault, LineBreakpoint, watches_of
from openacr.debugger.calls import PROGRAMS, Frame, frames_of, listing, name_of, owners
from openacr.debugger.opening import opened
from openacr.debugger.session import DebugSession, Reason, Stop
from openacr.debugger.sources import Sources
from openacr.debugger.variables import Value, axis_states, locals_of, program_state, time_state
from openacr.errors import OpenacrError, UserError
from openacr.timeline import Moment

Json = dict[str, Any]
Handler = Callable[["Adapter", Any], Json | None]

_HANDLERS: dict[str, tuple[type[requests.Arguments], Handler]] = {}
FRAMES = 100  # frame ids: thread times this, plus the depth

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


class Adapter:
    """Answers the requests of one client, and reports events by `send`."""

    def __init__(self, send: Callable[[Json], None]) -> None:
        self._send = send
        self._sequence = 0
        self._session: DebugSession | None = None
        self.is_running = False
        self.is_ended = False
        self.speed = 1.0  # 0: as fast as it goes
        self.is_stopped_at_entry = False
        self._held: dict[int, tuple[int, tuple[Value, ...]]] = {}  # by variables reference
        self.stop: Stop | None = None
        self._breakpoints: dict[str, list[LineBreakpoint]] = {}

    @property
    def session(self) -> DebugSession:
        """The debugged card; UserError before there is one."""
        if self._session is None:
            raise UserError("no card is debugged yet: launch one")
        return self._session

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
            self.event("initialized")

    def _answer(self, command: object, arguments: object) -> Json | None:
        found = _HANDLERS.get(command) if isinstance(command, str) else None
        if found is None:
            raise UserError(f"{command}: this debugger has no such request")
        form, handler = found
        try:
            read = msgspec.convert(arguments, form)
        except msgspec.ValidationError as error:
            raise UserError(f"{command}: {error}") from None
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

    def begin(self, session: DebugSession) -> None:
        """Debug a card from now on."""
        self._session = session
        session.card.listen(lambda program, text: self.show(text, "stdout"))

    def resume(self) -> None:
        """Let the card run until `advance` finds a reason to stop."""
        self._held.clear()
        self.is_running = True

    def advance(self, ticks: int) -> None:
        """Advance the running card; called again and again by the server."""
        try:
            stop = self.session.run(ticks)
        except OpenacrError as error:  # of a journal that does not fit
            stop = Stop(Reason.EXCEPTION, None, str(error))
        text = questions.heard(self.session.card)
        if text:
            self.show(text)
        if stop is not None:
            self.stopped(stop)

    def stopped(self, stop: Stop) -> None:
        """Report that the card stands."""
        self.is_running = False
        self.stop = stop
        self._held.clear()
        known = [*owners(self.session.card), 0]
        program = known[0] if stop.program is None else stop.program
        self.event(
            "stopped",
            reason=stop.reason.value,
            threadId=program + 1,
            allThreadsStopped=True,
            **({"description": stop.text, "text": stop.text} if stop.text else {}),
        )

    def keep(self, owner: int, elements: tuple[Value, ...]) -> int:
        """A reference to values of a program until the card runs again; 0 for none."""
        if not elements:
            return 0
        self._held[len(self._held) + 1] = owner, elements
        return len(self._held)

    def held(self, reference: int) -> tuple[int, tuple[Value, ...]]:
        """The program and the values that a reference means."""
        if reference not in self._held:
            raise UserError("these values are of an earlier stop")
        return self._held[reference]

    def standing(self) -> DebugSession:
        """The debugged card, which must stand; UserError while it runs."""
        if self.is_running:
            raise UserError("the card runs: pause it first")
        return self.session

    def set_breakpoints_of(self, source: str, breakpoints: list[LineBreakpoint]) -> None:
        """Replace the breakpoints of a file or listing."""
        self._breakpoints[source] = breakpoints
        self.session.set_lines([each for found in self._breakpoints.values() for each in found])


@request(requests.Initialize)
def initialize(adapter: Adapter, arguments: requests.Initialize) -> Json:
    """Say what the debugger can do."""
    return CAPABILITIES


@request(requests.Launch)
def launch(adapter: Adapter, arguments: requests.Launch) -> None:
    """Load a project, or the card of a journal."""
    card, journal = opened(arguments)
    session = DebugSession(card, adapter.show)
    if journal is not None:
        last_tk = max([journal.header.tick, *(entry.tick for entry in journal.entries)])
        session.timeline.foresee(journal.entries, last_tk)
    adapter.speed = arguments.speed
    adapter.is_stopped_at_entry = arguments.stop_on_entry
    adapter.begin(session)
    for program in arguments.run:
        questions.run_program(card, program)


@request(requests.Nothing)
def configuration_done(adapter: Adapter, arguments: requests.Nothing) -> None:
    """Begin to run, or stand at the beginning."""
    if adapter.is_stopped_at_entry:
        adapter.stopped(adapter.session.entry())
    else:
        adapter.session.entry()
        adapter.resume()


# breakpoints


@request(requests.SetBreakpoints)
def set_breakpoints(adapter: Adapter, arguments: requests.SetBreakpoints) -> Json:
    """Stop before lines of a file, or of the listing of a program."""
    session = adapter.session
    source = arguments.source
    lines = _lines(session, source)
    kept, answers = [], []
    for each in arguments.breakpoints:
        found = lines.get(each.line)
        answer: Json = {"verified": False, "line": each.line}
        if found is None:
            answer["message"] = "no line of a program on the card comes from here"
        elif found[0] >= PROGRAMS:
            answer["message"] = "a PLC has no lines to stop at: watch one of its flags"
        else:
            hits = _hits(each.hit_condition)
            kept.append(LineBreakpoint(*found, each.condition, hits, each.log_message))
            answer = {"verified": True, "line": each.line}
        answers.append(answer)
    adapter.set_breakpoints_of(source.path or str(source.source_reference), kept)
    return {"breakpoints": answers}


def _lines(session: DebugSession, source: requests.Source) -> dict[int, tuple[int, int]]:
    sources = Sources(session.card)
    if source.source_reference:
        return sources.lines_listed(source.source_reference - 1)
    return sources.lines_of(source.path)


def _hits(text: str) -> int:
    digits = text.strip().removeprefix(">=").strip()
    if not digits:
        return 1
    if not digits.isdigit() or not 0 < int(digits) < 1 << 31:
        raise UserError(f"{text}: the count of hits is a number from 1 on")
    return int(digits)


@request(requests.BreakpointLocations)
def breakpoint_locations(adapter: Adapter, arguments: requests.BreakpointLocations) -> Json:
    """The lines of a range at which programs can stop."""
    last = arguments.end_line or arguments.line
    found = _lines(adapter.session, arguments.source)
    lines = [n for n in range(arguments.line, last + 1) if n in found and found[n][0] < PROGRAMS]
    return {"breakpoints": [{"line": line} for line in lines]}


@request(requests.DataBreakpointInfo)
def data_breakpoint_info(adapter: Adapter, arguments: requests.DataBreakpointInfo) -> Json:
    """Whether changes of a value can be watched."""
    name = arguments.name.strip().upper()
    try:
        list(watches_of(adapter.session.card, name))
    except OpenacrError as error:
        return {"dataId": None, "description": str(error)}
    return {"dataId": name, "description": f"{name} changes", "accessTypes": ["write"]}


@request(requests.SetDataBreakpoints)
def set_data_breakpoints(adapter: Adapter, arguments: requests.SetDataBreakpoints) -> Json:
    """Stop after the tick in which values change."""
    wanted = [DataBreakpoint(each.data_id, each.condition) for each in arguments.breakpoints]
    adapter.session.set_data(wanted)
    return {"breakpoints": [{"verified": True}] * len(wanted)}


@request(requests.SetExceptionBreakpoints)
def set_exception_breakpoints(
    adapter: Adapter, arguments: requests.SetExceptionBreakpoints
) -> None:
    """Stop at faults."""
    adapter.session.set_faults(frozenset(arguments.filters))


# where it stands


@request(requests.Nothing)
def threads(adapter: Adapter, arguments: requests.Nothing) -> Json:
    """The programs and PLCs that have a text."""
    found = owners(adapter.session.card) or [0]
    return {"threads": [{"id": owner + 1, "name": name_of(owner)} for owner in found]}


@request(requests.StackTrace)
def stack_trace(adapter: Adapter, arguments: requests.StackTrace) -> Json:
    """The present line of a program and the lines that called its routine."""
    card = adapter.session.card
    owner = arguments.thread_id - 1
    frames = frames_of(card, owner) if 0 <= owner < PROGRAMS else []
    shown = [_frame(adapter, depth, frame) for depth, frame in enumerate(frames)]
    end = arguments.start_frame + arguments.levels if arguments.levels else None
    return {"stackFrames": shown[arguments.start_frame : end], "totalFrames": len(shown)}


def _frame(adapter: Adapter, depth: int, frame: Frame) -> Json:
    thread = frame.owner + 1
    source: Json = {"name": f"{name_of(frame.owner)} (listing)", "sourceReference": thread}
    line = Sources(adapter.session.card).listed_place(frame.owner, frame.line)
    if frame.path:
        source, line = {"path": frame.path, "name": frame.path.rpartition("/")[2]}, frame.file_line
    return {
        "id": thread * FRAMES + depth, "name": f"{name_of(frame.owner)} line {frame.line}",
        "line": line, "column": 1, "source": source,
    }  # fmt: skip


@request(requests.SourceRequest)
def source(adapter: Adapter, arguments: requests.SourceRequest) -> Json:
    """The listing of a program."""
    owner = arguments.source_reference - 1
    if owner not in owners(adapter.session.card):
        raise UserError(f"there is no listing {arguments.source_reference}")
    return {"content": "\n".join(listing(adapter.session.card, owner)) + "\n"}


@request(requests.Scopes)
def scopes(adapter: Adapter, arguments: requests.Scopes) -> Json:
    """The groups of values of a program."""
    card = adapter.standing().card
    owner = arguments.frame_id // FRAMES - 1
    if not 0 <= owner < PROGRAMS:
        raise UserError(f"there is no frame {arguments.frame_id}")
    groups: Iterable[tuple[str, Iterable[Value]]] = (
        ("Variables", locals_of(card, owner)),
        ("Axes", axis_states(card, owner)),
        ("Program", program_state(card, owner)),
        ("Time", time_state(card)),
    )
    shown = [(name, adapter.keep(owner, tuple(values))) for name, values in groups]
    return {
        "scopes": [
            {"name": name, "variablesReference": reference, "expensive": False}
            for name, reference in shown
            if reference
        ]
    }


@request(requests.Variables)
def variables(adapter: Adapter, arguments: requests.Variables) -> Json:
    """The values of a group or array."""
    adapter.standing()
    owner, values = adapter.held(arguments.variables_reference)
    end = arguments.start + arguments.count if arguments.count else None
    return {
        "variables": [
            {
                "name": value.name, "value": value.text, "evaluateName": value.name,
                "variablesReference": adapter.keep(owner, value.elements),
                **({"indexedVariables": len(value.elements)} if value.elements else {}),
            }
            for value in values[arguments.start : end]
        ]
    }  # fmt: skip


def _owner(frame: int | None) -> int:
    return 0 if frame is None else max(0, frame // FRAMES - 1)


@request(requests.Evaluate)
def evaluate(adapter: Adapter, arguments: requests.Evaluate) -> Json:
    """The value of an expression; in the console, what the card answers to a typed line."""
    owner = _owner(arguments.frame_id)
    if arguments.context == "repl":
        card = adapter.session.card
        return {
            "result": questions.typed(card, owner, arguments.expression),
            "variablesReference": 0,
        }
    card = adapter.standing().card
    result = questions.answer(card, owner, arguments.expression)
    return {"result": result, "variablesReference": 0}


@request(requests.SetVariable)
def set_variable(adapter: Adapter, arguments: requests.SetVariable) -> Json:
    """Change a variable of a program; in the past, this begins another branch."""
    owner, values = adapter.held(arguments.variables_reference)
    if arguments.name not in {value.name for value in values}:
        raise UserError(f"{arguments.name} is not one of these values")
    return _assigned(adapter, owner, arguments.name, arguments.value)


@request(requests.SetExpression)
def set_expression(adapter: Adapter, arguments: requests.SetExpression) -> Json:
    """Change a parameter, flag or variable; in the past, this begins another branch."""
    return _assigned(adapter, _owner(arguments.frame_id), arguments.expression, arguments.value)


def _assigned(adapter: Adapter, owner: int, target: str, value: str) -> Json:
    card = adapter.standing().card
    questions.assign(card, owner, target, value)
    return {"value": questions.answer(card, owner, target)}


@request(requests.OfThread)
def exception_info(adapter: Adapter, arguments: requests.OfThread) -> Json:
    """The fault at which the card has stopped."""
    stop = adapter.stop
    if stop is None:
        raise UserError("the card has not stopped yet")
    return {"exceptionId": stop.reason.value, "description": stop.text, "breakMode": "always"}


# going on


@request(requests.OfThread)
def continue_(adapter: Adapter, arguments: requests.OfThread) -> Json:
    """Run until something stops the card."""
    adapter.standing()
    adapter.resume()
    return {"allThreadsContinued": True}


def _step(
    adapter: Adapter, arguments: requests.Step, *, into: bool = False, out: bool = False
) -> None:
    program = arguments.thread_id - 1
    session = adapter.standing()
    if arguments.granularity == "instruction" or program >= PROGRAMS:
        adapter.stopped(session.tick())
        return
    session.begin_step(program, into=into, out=out)
    adapter.resume()


@request(requests.Step)
def next_(adapter: Adapter, arguments: requests.Step) -> None:
    """Step to the next line, over routines that are called; by instruction: one servo interrupt."""
    _step(adapter, arguments)


@request(requests.Step)
def step_in(adapter: Adapter, arguments: requests.Step) -> None:
    """Step to the next line, into routines."""
    _step(adapter, arguments, into=True)


@request(requests.Step)
def step_out(adapter: Adapter, arguments: requests.Step) -> None:
    """Step to the line after the call of the present routine."""
    _step(adapter, arguments, out=True)


@request(requests.Step)
def step_back(adapter: Adapter, arguments: requests.Step) -> None:
    """Go back to the line that the program has executed before."""
    session = adapter.standing()
    program = arguments.thread_id - 1
    if arguments.granularity == "instruction" or program >= PROGRAMS:
        adapter.stopped(session.tick_back())
    else:
        adapter.stopped(session.step_back(program))


@request(requests.OfThread)
def reverse_continue(adapter: Adapter, arguments: requests.OfThread) -> None:
    """Go back to the last stop before the present."""
    adapter.stopped(adapter.standing().run_back())


@request(requests.OfThread)
def pause(adapter: Adapter, arguments: requests.OfThread) -> None:
    """Stop where the card is."""
    if adapter.is_running:
        adapter.stopped(adapter.session.paused(arguments.thread_id - 1))


@request(requests.Seek)
def openacr_seek(adapter: Adapter, arguments: requests.Seek) -> Json:
    """Go to a tick of the present branch, or of another one."""
    session = adapter.standing()
    if arguments.branch is not None:
        session.timeline.switch(arguments.branch)
    adapter.stopped(session.seek(Moment(arguments.tick, arguments.within)))
    return {}


@request(requests.Nothing)
def openacr_timeline(adapter: Adapter, arguments: requests.Nothing) -> Json:
    """The branches of the history, and the present moment."""
    timeline = adapter.session.timeline
    return {
        "branch": timeline.branch.number,
        "tick": timeline.now.tick,
        "within": timeline.now.within,
        "period_s": adapter.session.card.period_s,
        "bytes": timeline.size_bytes,
        "branches": [
            {
                "number": each.number, "parent": each.parent, "first": each.first.tick,
                "last": each.last.tick, "fork": each.fork.tick if each.fork else None,
            }
            for each in timeline.branches
        ],
    }  # fmt: skip


@request(requests.Nothing)
def disconnect(adapter: Adapter, arguments: requests.Nothing) -> None:
    """End the session and the card."""
    adapter.is_running = False
    adapter.is_ended = True


@request(requests.Nothing)
def terminate(adapter: Adapter, arguments: requests.Nothing) -> None:
    """End the card."""
    adapter.is_running = False
    adapter.is_ended = True
    adapter.event("terminated")
