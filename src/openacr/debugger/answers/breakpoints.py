"""Where the card stops: lines, values, faults."""

from __future__ import annotations

from openacr.debugger import requests
from openacr.debugger.adapter import Adapter, Json, request
from openacr.debugger.breakpoints import DataBreakpoint, LineBreakpoint, watches_of
from openacr.debugger.calls import PROGRAMS
from openacr.debugger.session import DebugSession
from openacr.debugger.sources import Sources
from openacr.errors import OpenacrError, UserError


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
