"""Where programs stand, and the values they see there."""

from __future__ import annotations

from collections.abc import Iterable

from openacr.debugger import questions, requests
from openacr.debugger.adapter import Adapter, Json, request
from openacr.debugger.calls import PROGRAMS, Frame, frames_of, listing, name_of, owners
from openacr.debugger.sources import Sources
from openacr.debugger.variables import Value, axis_states, locals_of, program_state, time_state
from openacr.errors import UserError

FRAMES = 100  # frame ids: thread times this, plus the depth


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
