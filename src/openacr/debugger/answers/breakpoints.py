"""Where the card stops: lines, values, faults."""

from __future__ import annotations

from openacr.debugger import requests
from openacr.debugger.adapter import Adapter, Json, request
from openacr.debugger.breakpoints import DataBreakpoint, LineBreakpoint
from openacr.debugger.target import NO_STATEMENT, Target
from openacr.errors import OpenacrError, UserError


@request(requests.SetBreakpoints)
def set_breakpoints(adapter: Adapter, arguments: requests.SetBreakpoints) -> Json:
    """Stop before lines of a file, or of the listing of a program."""
    target, source = adapter.target, arguments.source
    wanted = frozenset(each.line for each in arguments.breakpoints)
    lines = target.places_of(source.path, source.source_reference, wanted)
    kept, answers = [], list[Json]()
    for each in arguments.breakpoints:
        try:
            kept.append(_line_breakpoint(target, each, lines.get(each.line)))
            answers.append({"verified": True, "line": each.line})
        except UserError as refused:  # the others count all the same
            answers.append({"verified": False, "line": each.line, "message": str(refused)})
    adapter.set_breakpoints_of(source.path or str(source.source_reference), kept)
    return {"breakpoints": answers}


def _line_breakpoint(
    target: Target, asked: requests.SourceBreakpoint, place: tuple[int, int] | None
) -> LineBreakpoint:
    """A breakpoint at a place of a program; UserError says why there can be none."""
    if place is None:
        raise UserError(NO_STATEMENT)
    if reason := target.why_no_stop(place):
        raise UserError(reason)
    hits = _hits(asked.hit_condition)
    return LineBreakpoint(*place, asked.condition, hits, asked.log_message)


def _hits(text: str) -> int:
    digits = text.strip().removeprefix(">=").strip()
    if not digits:
        return 1
    if not digits.isdecimal() or not 0 < int(digits) < 1 << 31:
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
    kept, answers = [], list[Json]()
    for each in arguments.breakpoints:
        try:
            adapter.target.require_watchable(each.data_id)
            kept.append(DataBreakpoint(each.data_id, each.condition))
            answers.append({"verified": True})
        except OpenacrError as refused:  # the others count all the same
            answers.append({"verified": False, "message": str(refused)})
    adapter.target.course.set_data(kept)
    return {"breakpoints": answers}


@request(requests.SetExceptionBreakpoints)
def set_exception_breakpoints(
    adapter: Adapter, arguments: requests.SetExceptionBreakpoints
) -> None:
    """Stop at faults."""
    adapter.target.course.set_faults(frozenset(arguments.filters))
