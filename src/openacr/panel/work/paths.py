"""The tool path of a program as one block of bytes for browsers, and what reading it shows.

| offset | type | what |
|---|---|---|
| 0 | char[4] | `OAP2` |
| 4 | u32 | points N |
| 8 | u32 | polylines M |
| 12 | u32 | flags: 1 = millimetres, 2 = cut off at the most points |
| 16 | f32[6] | lowest and highest X Y Z |
| 40 | f64 | predicted seconds, NaN: unknown |
| 48 | f32[3] | program 0 of the first work system |
| 60 | f32[6] | lowest and highest X Y Z of the blank, NaN: its sizes are not stored |
| 84 | u32 | 0 |
| 88 | f32[3N] | points, machine coordinates |
| .. | u32[N] | line of the program that draws to each point |
| .. | u32[M] | first point of each polyline; its last one is the first of the next |
| .. | u8[M] | kind: 0 rapid, 1 feed, 2 compensated, 3 inserted |
| .. | u8[M] | colour, 0 to 15 |
"""

import gzip
import math
import struct
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from openacr.cnc.interpreter.interpreter import Interpreter, Options
from openacr.cnc.interpreter.survey import Survey
from openacr.cnc.loading.load import axes_of, load
from openacr.cnc.program.program import Program
from openacr.cnc.reading.findings import Finding
from openacr.cnc.state.hosts import VirtualMachine
from openacr.cnc.state.shadow import Shadow
from openacr.mill.card.alarms import ANSWER_MISSING
from openacr.mill.config.dialects import choose
from openacr.mill.config.folders import folders_of
from openacr.mill.plan.estimate.checking import checked
from openacr.mill.plan.pictures.blank import blank_of, has_sizes, heights_of_zero
from openacr.mill.plan.pictures.tool_path import Drawing, Kind, ToolPath
from openacr.sysvar import Store
from openacr.sysvar.tabs import CONTROL, DISPLAY, SPEEDS, TOOL

MARK = b"OAP2"
HEAD = struct.Struct("<4sIII6fd9fI")
DRAWN = "XYZ"
PACKED = 1  # level of gzip: the path of 200,000 points in some tens of ms
MOST_FINDINGS = 500
UNANSWERED = f"A{ANSWER_MISSING.code}"  # a reading without operator ends there


@dataclass(slots=True)
class Found:
    """What reading a whole program shows."""

    seconds: float | None = None
    extents: dict[str, list[float]] | None = None
    tools: list[int] = field(default_factory=list)
    findings: list[dict[str, Any]] = field(default_factory=list)
    packed: bytes = b""  # the path, gzip

    def facts(self) -> dict[str, Any]:
        """Time, extents and tools."""
        return {"seconds": self.seconds, "extents": self.extents, "tools": self.tools}


def finding_data(finding: Finding) -> dict[str, Any]:
    """A finding as JSON; a question of the program is no error: an operator answers it."""
    is_error = finding.is_error and finding.code != UNANSWERED
    return {
        "line": finding.line,
        "column": finding.column,
        "severity": "error" if is_error else "warning",
        "code": finding.code,
        "text": finding.text,
        "hint": finding.hint,
        "file": finding.file,
    }


def read_file(file: Path, store: Path, dialect: str, *, has_path: bool = True) -> Found:
    """Read the program in a file as the machine of a store would run it."""
    with Store(store) as cells:
        name = choose(file, cells, dialect or None).name
        program = load(file, cells, name, folders_of(cells, store.parent))
        return _read(program, cells, name, has_path=has_path)


def check_text(text: str, name: str, folder: Path, store: Path, dialect: str) -> Found:
    """Check a text that is being edited; files it includes are found in `folder`."""
    with Store(store) as cells:
        language = dialect or choose(None, cells).name
        program = load(text, cells, language, folders_of(cells, store.parent), name, folder)
        return _read(program, cells, language, has_path=False)


def draw_text(text: str, name: str, store: Path) -> Found:
    """The path of a text, for previews of library parts."""
    with Store(store) as cells:
        program = load(text, cells, "acromill", folders_of(cells, store.parent), name)
        return _read(program, cells, "acromill", has_path=True)


def _read(program: Program, cells: Store, dialect: str, *, has_path: bool) -> Found:
    letters = axes_of(cells)
    axes = tuple(letters[letter] for letter in DRAWN if letter in letters)
    path = ToolPath(axes, cells.read(SPEEDS.chord_tolerance))
    options, look = (Options(watch=path), path.add) if has_path else (Options(), None)
    found, prediction = checked(program, cells, dialect, options=options, rounds=False, look=look)
    seconds = None if found.errors else prediction.time_s
    data = Found(
        seconds,
        _extents(found),
        list(dict.fromkeys(found.tools)),
        [finding_data(each) for each in found.findings[:MOST_FINDINGS]],
    )
    if has_path:
        path.has_tools = bool(cells.read(DISPLAY.color_via_d_codes))
        drawing = path.finished()
        zero = _zero(program, cells, dialect, axes)
        blank = _blank(program, cells, dialect, drawing)
        flags = int(bool(cells.read(CONTROL.default_units))) | (2 if path.is_full else 0)
        packed = _blob(drawing, cells, flags, seconds, [*zero, *blank])
        data.packed = gzip.compress(packed, PACKED)
    return data


def _extents(found: Survey) -> dict[str, list[float]] | None:
    ends = {
        letter: [found.low[axis], found.high[axis]]
        for letter, axis in found.letters.items()
        if math.isfinite(found.low[axis])
    }
    return ends or None


def _zero(program: Program, cells: Store, dialect: str, axes: tuple[int, ...]) -> list[float]:
    """Program 0 at the start of the program, machine coordinates."""
    run = Interpreter(program, Shadow(cells), VirtualMachine(), dialect)
    run.path.refresh()
    place = run.path.coordinates.to_machine((0.0,) * 8)
    return [*(place[axis] for axis in axes), 0.0, 0.0, 0.0][:3]


def _blank(program: Program, cells: Store, dialect: str, drawing: Drawing) -> list[float]:
    """The lowest and highest places of the blank; NaN where no size is stored or nothing is cut."""
    cuts = np.flatnonzero(drawing.kinds != Kind.RAPID)
    if not len(cuts) or not has_sizes(cells) or any(n not in axes_of(cells) for n in DRAWN):
        return [math.nan] * 6
    places = np.vstack([drawing.points[cuts], drawing.points[cuts + 1]])
    _tip, spindle = heights_of_zero(program, cells, dialect)
    blank = blank_of(cells, places.min(axis=0).tolist(), places.max(axis=0).tolist(), spindle)
    return [*blank.low, *blank.high]


def _blob(
    drawing: Drawing, cells: Store, flags: int, seconds: float | None, zero_and_blank: list[float]
) -> bytes:
    points = drawing.points.astype("<f4")
    firsts, kinds, tools = _polylines(drawing)
    colors = np.array([_color(cells, Kind(k), t) for k, t in zip(kinds, tools, strict=True)], "u1")
    lines = np.concatenate([[0], drawing.lines]).astype("<u4")
    box = [*points.min(axis=0).tolist(), *points.max(axis=0).tolist()]
    time_s = math.nan if seconds is None else seconds
    head = HEAD.pack(MARK, len(points), len(firsts), flags, *box, time_s, *zero_and_blank, 0)
    parts = (points, lines, firsts.astype("<u4"), kinds.astype("u1"), colors)
    return head + b"".join(part.tobytes() for part in parts)


def _polylines(drawing: Drawing) -> tuple[Any, Any, Any]:
    """Where each run of moves of one kind and tool begins, with both."""
    kinds, tools = drawing.kinds.astype(np.int64), drawing.tools
    if not len(kinds):
        empty = np.zeros(0, np.int64)
        return empty, empty, empty
    is_new = np.ones(len(kinds), np.bool_)
    is_new[1:] = (np.diff(kinds) != 0) | (np.diff(tools) != 0)
    firsts = np.flatnonzero(is_new)
    return firsts, kinds[firsts], tools[firsts]


def _color(cells: Store, kind: Kind, tool: int) -> int:
    if kind in (Kind.FEED, Kind.COMPENSATED) and tool and tool < len(TOOL.colour):
        return int(cells.read(TOOL.colour[tool]))
    return int(cells.read(CONTROL.path_color))
