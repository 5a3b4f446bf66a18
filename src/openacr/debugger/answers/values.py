"""Where programs stand, and the values they see there."""

from __future__ import annotations

from pathlib import Path

from openacr.debugger import requests
from openacr.debugger.adapter import Adapter, Json, request
from openacr.debugger.target import Frame
from openacr.errors import UserError

FRAMES = 100  # frame ids: thread times this, plus the depth


@request(requests.Nothing)
def threads(adapter: Adapter, arguments: requests.Nothing) -> Json:
    """The owners of lines: the programs and PLCs that have a text, or the part program."""
    return {"threads": [{"id": n + 1, "name": name} for n, name in adapter.target.owners()]}


@request(requests.StackTrace)
def stack_trace(adapter: Adapter, arguments: requests.StackTrace) -> Json:
    """The present line of a program and the lines that called its routine."""
    first = arguments.thread_id * FRAMES
    frames = adapter.target.frames(arguments.thread_id - 1)
    shown = [_frame(first + depth, frame) for depth, frame in enumerate(frames)]
    end = arguments.start_frame + arguments.levels if arguments.levels else None
    return {"stackFrames": shown[arguments.start_frame : end], "totalFrames": len(shown)}


def _frame(number: int, frame: Frame) -> Json:
    source: Json = {"path": frame.path, "name": Path(frame.path).name}
    if frame.listing:
        source = {"name": frame.path, "sourceReference": frame.listing}
    return {
        "id": number, "name": frame.name, "line": frame.line, "column": 1, "source": source
    }  # fmt: skip


@request(requests.SourceRequest)
def source(adapter: Adapter, arguments: requests.SourceRequest) -> Json:
    """The listing of a program."""
    return {"content": adapter.target.listing(arguments.source_reference)}


@request(requests.Scopes)
def scopes(adapter: Adapter, arguments: requests.Scopes) -> Json:
    """The groups of values at a frame."""
    target = adapter.standing()
    thread, depth = divmod(arguments.frame_id, FRAMES)
    if thread < 1:
        raise UserError(f"there is no frame {arguments.frame_id}")
    groups = target.scopes(thread - 1, depth)
    shown = [(name, adapter.keep(thread - 1, tuple(values))) for name, values in groups]
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
        result = adapter.target.typed(owner, arguments.expression)
    else:
        result = adapter.standing().answer(owner, arguments.expression)
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
    debugged = adapter.standing()
    debugged.assign(owner, target, value)
    return {"value": debugged.answer(owner, target)}


@request(requests.OfThread)
def exception_info(adapter: Adapter, arguments: requests.OfThread) -> Json:
    """The fault at which the card has stopped."""
    stop = adapter.stop
    if stop is None:
        raise UserError("the card has not stopped yet")
    return {"exceptionId": stop.reason.value, "description": stop.text, "breakMode": "always"}
