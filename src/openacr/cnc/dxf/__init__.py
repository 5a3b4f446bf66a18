"""DXF drawings as programs: a path that is cut, holes that are drilled, moves in AcroBASIC."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from pathlib import Path

from openacr.cnc.dxf.chains import Chain, Joiner, directed
from openacr.cnc.dxf.doubles import without_doubles
from openacr.cnc.dxf.motion import MotionMachine, motion_program
from openacr.cnc.dxf.reading import Drawing2D, read
from openacr.cnc.dxf.routing import CutPath, Tool, routed
from openacr.cnc.dxf.writing import Numbers, drill_program, nearest_first, path_program
from openacr.errors import UserError
from openacr.units import MM_PER_INCH
from openacr.wording import counted

CHORD_R = 0.1  # height of chords for curves, of epsilon
DRILLED = frozenset(("POINT", "CIRCLE"))
STRAIGHT_R = 0.01  # arcs flatter than this much of epsilon are lines


class Pattern(Enum):
    """What a drawing is read as."""

    PATH = "path"
    DRILL = "drill"


@dataclass(frozen=True, slots=True)
class Options:
    """How a drawing is converted; lengths in default units (`is_metric`)."""

    pattern: Pattern = Pattern.PATH
    is_counter_clockwise: bool = False
    layer: str = ""
    is_metric: bool = False
    epsilon: float = 0.002
    safe_height: float = 0.1
    drill_bottom: float = -0.5
    drill_level: float = 0.1
    drill_feed: float = 10.0
    feed: float | None = None
    cut_z: float = 0.0  # of the path
    d_number: int = 0  # cutter compensation with this radius, 0 none
    radius: float = 0.0  # of that tool
    lead: float = 0.25  # radius of lead-in and lead-out


@dataclass(frozen=True, slots=True)
class Conversion:
    """A part program, and notes for the user."""

    text: str
    is_metric: bool
    notes: tuple[str, ...]
    summary: str


def convert(path: Path, options: Options) -> Conversion:
    """Convert a drawing to a part program; UserError if it has nothing to convert."""
    drawing = _read(path, options)
    made = _path if options.pattern is Pattern.PATH else _holes
    text, summary = made(path, drawing, options)
    return Conversion(text, drawing.is_metric, tuple(_notes(drawing, options.pattern)), summary)


def _read(path: Path, options: Options) -> Drawing2D:
    return read(
        path,
        layer=options.layer,
        is_metric=options.is_metric,
        chord=lambda is_metric: CHORD_R * _in_unit(options.epsilon, options, is_metric),
    )


def _in_unit(value: float, options: Options, is_metric: bool) -> float:
    if is_metric == options.is_metric:
        return value
    return value * MM_PER_INCH if is_metric else value / MM_PER_INCH


def convert_to_moves(path: Path, options: Options, machine: MotionMachine) -> Conversion:
    """Convert a drawing to an AcroBASIC program; UserError if there is nothing to cut."""
    drawing = _read(path, options)
    paths, summary = _paths(path, drawing, options)
    unit = "mm" if drawing.is_metric else "inch"
    text = motion_program(
        [each for each in paths if isinstance(each, Chain)],
        Numbers(drawing.is_metric),
        machine,
        title=f"{_printable(path.name)}: {summary}, in {unit}",
        straight=STRAIGHT_R * _in_unit(options.epsilon, options, drawing.is_metric),
    )
    return Conversion(text, drawing.is_metric, tuple(_notes(drawing, Pattern.PATH)), summary)


def _path(path: Path, drawing: Drawing2D, options: Options) -> tuple[str, str]:
    def unit(value: float) -> float:
        return _in_unit(value, options, drawing.is_metric)

    paths, summary = _paths(path, drawing, options)
    text = path_program(
        paths,
        Numbers(drawing.is_metric),
        title=f"{_printable(path.name)}: {summary}",
        safe_height=unit(options.safe_height),
        feed=None if options.feed is None else unit(options.feed),
        cut_z=unit(options.cut_z),
        straight=STRAIGHT_R * unit(options.epsilon),
        d_number=options.d_number,
    )
    return text, summary


def _paths(path: Path, drawing: Drawing2D, options: Options) -> tuple[list[CutPath], str]:
    """The paths of a drawing in their order, and how many there are in words."""

    def unit(value: float) -> float:
        return _in_unit(value, options, drawing.is_metric)

    if not drawing.pieces:
        raise UserError(f"{path}: there is nothing to cut{_where(options)}")
    pieces = without_doubles(drawing.pieces, unit(options.epsilon))
    if len(pieces) < len(drawing.pieces):
        count = len(drawing.pieces) - len(pieces)
        drawing.notes.append(f"drawn twice, left out: {count}")
    joiner = Joiner(pieces, unit(options.epsilon))
    if joiner.merged_cnt:
        drawing.notes.append(f"shorter than epsilon inside a joint, left out: {joiner.merged_cnt}")
    chains = directed(joiner.chains(), is_counter_clockwise=options.is_counter_clockwise)
    route = routed(chains, _tool(options, unit))
    drawing.notes += route.notes
    if not route.paths:
        raise UserError(f"{path}: D{options.d_number} has no room anywhere")
    closed = sum(chain.is_closed for chain in chains)
    summary = (
        f"{counted(len(chains), 'chain')} ({closed} closed) of {counted(len(pieces), 'entity')}"
    )
    return route.paths, summary


def _tool(options: Options, unit: Callable[[float], float]) -> Tool | None:
    if not options.d_number:
        return None
    return Tool(options.d_number, unit(options.radius), unit(options.lead))


def _holes(path: Path, drawing: Drawing2D, options: Options) -> tuple[str, str]:
    def unit(value: float) -> float:
        return _in_unit(value, options, drawing.is_metric)

    holes = nearest_first(drawing.points + drawing.circles, unit(options.epsilon))
    if not holes:
        raise UserError(f"{path}: there are no points or circles to drill{_where(options)}")
    text = drill_program(
        holes,
        Numbers(drawing.is_metric),
        title=f"{_printable(path.name)}: {counted(len(holes), 'hole')}",
        safe_height=unit(options.safe_height),
        levels=(unit(options.drill_bottom), unit(options.drill_level)),
        feed=unit(options.drill_feed),
    )
    return text, counted(len(holes), "hole")


def _where(options: Options) -> str:
    return f" on layer {options.layer}" if options.layer else ""


def _printable(name: str) -> str:
    return "".join(letter if letter.isprintable() else "_" for letter in name)[:100]


def _notes(drawing: Drawing2D, pattern: Pattern) -> list[str]:
    unused = drawing.unused.copy()
    for kind, count in drawing.used.items():
        if (kind == "POINT") if pattern is Pattern.PATH else (kind not in DRILLED):
            unused[kind] += count
    listed = [f"{count} {kind}" for kind, count in sorted(unused.items())]
    return drawing.notes + ([f"not used: {', '.join(listed)}"] if listed else [])
