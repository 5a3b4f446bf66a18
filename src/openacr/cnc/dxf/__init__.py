"""DXF drawings as part programs: a path that is cut, or holes that are drilled."""

from dataclasses import dataclass
from enum import Enum
from pathlib import Path

from openacr.cnc.dxf.chains import directed, in_order, joined
from openacr.cnc.dxf.reading import Drawing2D, read
from openacr.cnc.dxf.writing import Numbers, drill_program, nearest_first, path_program
from openacr.errors import UserError

MM_PER_INCH = 25.4
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


@dataclass(frozen=True, slots=True)
class Conversion:
    """A part program, and what is to be said about it."""

    text: str
    is_metric: bool
    notes: tuple[str, ...]
    summary: str


def convert(path: Path, options: Options) -> Conversion:
    """The part program a drawing makes; UserError if there is nothing to make it of."""
    drawing = read(
        path,
        layer=options.layer,
        is_metric=options.is_metric,
        chord=lambda is_metric: CHORD_R * _in_unit(options.epsilon, options, is_metric),
    )
    made = _path if options.pattern is Pattern.PATH else _holes
    text, summary = made(path, drawing, options)
    return Conversion(text, drawing.is_metric, tuple(_notes(drawing, options.pattern)), summary)


def _in_unit(value: float, options: Options, is_metric: bool) -> float:
    if is_metric == options.is_metric:
        return value
    return value * MM_PER_INCH if is_metric else value / MM_PER_INCH


def _path(path: Path, drawing: Drawing2D, options: Options) -> tuple[str, str]:
    def unit(value: float) -> float:
        return _in_unit(value, options, drawing.is_metric)

    if not drawing.pieces:
        raise UserError(f"{path}: there is nothing to cut{_where(options)}")
    chains = joined(drawing.pieces, unit(options.epsilon))
    chains = in_order(directed(chains, is_counter_clockwise=options.is_counter_clockwise))
    closed = sum(chain.is_closed for chain in chains)
    summary = f"{len(chains)} chains ({closed} closed) of {len(drawing.pieces)} entities"
    text = path_program(
        chains,
        Numbers(drawing.is_metric),
        title=f"{_printable(path.name)}: {summary}",
        safe_height=unit(options.safe_height),
        feed=None if options.feed is None else unit(options.feed),
        straight=STRAIGHT_R * unit(options.epsilon),
    )
    return text, summary


def _holes(path: Path, drawing: Drawing2D, options: Options) -> tuple[str, str]:
    def unit(value: float) -> float:
        return _in_unit(value, options, drawing.is_metric)

    holes = nearest_first(drawing.points + drawing.circles, unit(options.epsilon))
    if not holes:
        raise UserError(f"{path}: there are no points or circles to drill{_where(options)}")
    text = drill_program(
        holes,
        Numbers(drawing.is_metric),
        title=f"{_printable(path.name)}: {len(holes)} holes",
        safe_height=unit(options.safe_height),
        levels=(unit(options.drill_bottom), unit(options.drill_level)),
        feed=unit(options.drill_feed),
    )
    return text, f"{len(holes)} holes"


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
