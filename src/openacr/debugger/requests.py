"""The arguments of the requests of the Debug Adapter Protocol, with their types."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta, Struct

from openacr.debugger.breakpoints import Fault

Count = Annotated[int, Meta(ge=0, lt=1 << 31)]
Tick = Annotated[int, Meta(ge=0, lt=1 << 62)]
Text = Annotated[str, Meta(max_length=4096)]
Program = Annotated[int, Meta(ge=0, le=15)]
Thread = Annotated[int, Meta(ge=1, le=24)]


class Arguments(Struct, rename="camel"):
    """Arguments whose names are written as the protocol does: `stopOnEntry`."""


class Nothing(Arguments):
    """A request without arguments that matter."""


class Initialize(Arguments):
    """`initialize`: lines count from 1, paths are paths."""

    lines_start_at1: bool = True
    path_format: str = "path"


class Launch(Arguments):
    """`launch`: a project folder or controller file, a journal, a part program, or a card (`host`).

    `devices` is the folder of Python files with devices of a journal; `store` and `dialect` are of
    a part program, `listen` (programs that are followed; those of `run`) of a card over a link.
    `run` names programs that are started; `speed` is the ratio to real time, 0 as
    fast as it goes. `secret` is the one that `openacr debug --port` has printed.
    """

    program: Text = ""
    journal: Text = ""
    devices: Text = ""
    part_program: Text = ""
    store: Text = ""
    dialect: Text = ""
    host: Text = ""
    listen: list[Program] = []
    run: list[Program] = []
    speed: Annotated[float, Meta(ge=0, le=1e6)] = 1.0
    stop_on_entry: bool = False
    secret: Text = ""


class Source(Arguments):
    """A file, or the listing of a program (its number plus 1)."""

    path: Text = ""
    source_reference: Annotated[int, Meta(ge=0, le=24)] = 0


class SourceBreakpoint(Arguments):
    """A line where to stop, with what must be so there."""

    line: Count
    condition: Text = ""
    hit_condition: Text = ""
    log_message: Text = ""


class SetBreakpoints(Arguments):
    """`setBreakpoints`: all those of a source."""

    source: Source
    breakpoints: list[SourceBreakpoint] = []


class BreakpointLocations(Arguments):
    """`breakpointLocations`: a range of lines."""

    source: Source
    line: Count
    end_line: Count | None = None


class DataBreakpointInfo(Arguments):
    """`dataBreakpointInfo`: the name of a value."""

    name: Text


class DataPoint(Arguments):
    """A value whose changes stop the card."""

    data_id: Text
    condition: Text = ""


class SetDataBreakpoints(Arguments):
    """`setDataBreakpoints`: all of them."""

    breakpoints: list[DataPoint]


class SetExceptionBreakpoints(Arguments):
    """`setExceptionBreakpoints`: the faults that stop the card."""

    filters: list[Fault]


class OfThread(Arguments):
    """A request about a thread."""

    thread_id: Thread = 1


class Step(Arguments):
    """A step of a thread; `granularity` "instruction" is one servo interrupt."""

    thread_id: Thread
    granularity: Text = "line"


class StackTrace(Arguments):
    """`stackTrace`: some frames of a thread."""

    thread_id: Thread
    start_frame: Count = 0
    levels: Count = 0


class SourceRequest(Arguments):
    """`source`: the listing of a program."""

    source_reference: Count


class Scopes(Arguments):
    """`scopes` of a frame."""

    frame_id: Count


class Variables(Arguments):
    """`variables`: those of a reference, or some of them."""

    variables_reference: Count
    start: Count = 0
    count: Count = 0


class Evaluate(Arguments):
    """`evaluate`: an expression or, in the console ("repl"), a line to be typed."""

    expression: Text
    frame_id: Count | None = None
    context: Text = "watch"


class SetVariable(Arguments):
    """`setVariable`: a value of a reference."""

    variables_reference: Count
    name: Text
    value: Text


class SetExpression(Arguments):
    """`setExpression`: a parameter, flag or variable."""

    expression: Text
    value: Text
    frame_id: Count | None = None


class Seek(Arguments):
    """`openacrSeek`: a moment, of another branch if one is given."""

    tick: Tick
    within: Count = 0
    branch: Count | None = None
