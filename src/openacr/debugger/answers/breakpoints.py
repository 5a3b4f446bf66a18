"""Where the card stops: lines, values, faults."""

from __future__ import annotations

from openacr.debugger import requests
from openacr.debugger.adapter import Adapter, Json, request
from openacr.debugger.breakpoints import DataBreakpoint, LineBreakpoint
from openacr.errors import OpenacrError, UserError


@request(requests.SetBreakpoints)
def set_breakpoints(adapter: Adapter, arguments: requests.SetBreakpoints) -> Json:
    """Stop before lines of a file, or of the listing of a program."""
    target, source = adapter.target, arguments.source
    wanted = frozenset(each.line for each in arguments.breakpoints)
    lines = target.places_of(source.path, source.source_reference, wanted)
    kept, answers = [], []
    for each in arguments.breakpoints:
        found = lines.get(each.line)
        answer: Json = {"verified": False, "line": each.line}
        if found is None:
            answer["message"] = "nothing is executed here"
        elif reason := target.why_no_stop(found):
            answer["message"] = reason
        else:
            hits = _hits(each.hit_condition)
            kept.append(LineBreakpoint(*found, each.condition, hits, each.log_message))
            answer = {"verified": True, "line": each.line}
        answers.append(answer)
    adapter.set_breakpoints_of(source.path or str(source.source_reference), kept)
    return {"breakpoints": answers}


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
    target, source = adapter.target, arguments.source
    wanted = range(arguments.line, (arguments.end_line or arguments.line) + 1)
    found = target.places_of(source.path, source.source_reference, wanted)
    lines = sorted(line for line, place in found.items() if not target.why_no_stop(place))
    return {"breakpoints": [{"line": line} for line in lines]}


@request(requests.DataBreakpointInfo)
def data_breakpoint_info(adapter: Adapter, arguments: requests.DataBreakpointInfo) -> Json:
    """Whether changes of a value can be watched."""
    name = arguments.name.strip().upper()
    try:
        adapter.target.require_watchable(name)
    except OpenacrError as error:
        return {"dataId": None, "description": str(error)}
    return {"dataId": name, "description": f"{name} changes", "accessTypes": ["write"]}


@request(requests.SetDataBreakpoints)
def set_data_breakpoints(adapter: Adapter, arguments: requests.SetDataBreakpoints) -> Json:
    """Stop after the tick in which values change."""
    wanted = [DataBreakpoint(each.data_id, each.condition) for each in arguments.breakpoints]
    adapter.target.set_data(wanted)
    return {"breakpoints": [{"verified": True}] * len(wanted)}


@request(requests.SetExceptionBreakpoints)
def set_exception_breakpoints(
    adapter: Adapter, arguments: requests.SetExceptionBreakpoints
) -> None:
    """Stop at faults."""
    adapter.target.set_faults(frozenset(arguments.filters))
