"""G0 to G3: rapid moves, lines and arcs."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from msgspec.structs import replace

from openacr.cnc.codes.fast import Does, Sets
from openacr.cnc.codes.gcodes.cycles import CYCLE_WORDS, drill
from openacr.cnc.codes.radii import Words, check_radii
from openacr.cnc.codes.table import Limit, Step, check_limit
from openacr.cnc.codes.tables import ACROMILL
from openacr.cnc.geometry import arcs
from openacr.cnc.reading.findings import CodeError
from openacr.cnc.state.cells import EPSILON
from openacr.cnc.state.modal import INVERSE_TIME

if TYPE_CHECKING:
    from openacr.cnc.canonical import Entry, Pace, Point
    from openacr.cnc.codes.run import Motions, Run
    from openacr.cnc.geometry.arcs import ArcGeometry
    from openacr.cnc.program.block_context import BlockContext

letter, sets = ACROMILL.letter, ACROMILL.sets
NO_CYCLE, NO_MOTION = 80, 80
CLOCKWISE, COUNTER_CLOCKWISE = -1, 1
SELECTS = Sets("motion"), Sets("cycle", NO_CYCLE)
_LENGTHS = "IJKR"
_TURNS = Limit("P", 1, 9999, "E222", is_whole=True)


sets(
    "G0 moves at rapid speed, G1 at feed, in a straight line; a cycle ends.",
    *(0, 1),
    forms=SELECTS,
)
sets(
    "G2 cuts arcs clockwise, G3 counter-clockwise, in P turns; a cycle ends.",
    *(2, 3),
    forms=SELECTS,
    words="IJKRP",
)


@letter("MOTION", step=Step.MOTION, fast=Does.MOVES)
def motion(run: Run, b: BlockContext) -> Iterator[Entry] | None:
    """Move as the active motion or cycle does."""
    if run.modal.cycle != NO_CYCLE:
        check_words(run, b, CYCLE_WORDS)
        return drill(run, b)
    return run.motions[run.modal.motion](run, b)


def check_words(run: Run, b: BlockContext, allowed: str) -> None:
    """Refuse words the active motion has no use for."""
    for word in b.plan.modal_words:
        if word not in allowed:
            raise meaningless(run, b, word)


def meaningless(run: Run, b: BlockContext, word: str) -> CodeError:
    """The error at a word that neither the codes of the block nor the active motion use."""
    names = [f"G{run.modal.motion:g}", *b.plan.code_names]
    hint = run.dialect.grammar.refusals.of_word(word, names)
    return b.fault("E206", word, word, hint)


def rapid(run: Run, b: BlockContext) -> None:
    """G0."""
    check_words(run, b, "")
    run.path.rapid(b, run.path.end(b))


def line(run: Run, b: BlockContext) -> None:
    """G1."""
    if b.plan.modal_words:
        check_words(run, b, "")
    end = run.path.end(b)
    run.path.line(b, end, _pace(run, b, end, None))


def _pace(run: Run, b: BlockContext, end: Point, arc: ArcGeometry | None) -> Pace:
    """How a feed move to a program point runs."""
    return pace_over(run, b, lambda: run.path.distance(end, arc, run.modal.plane_axes))


def pace_over(run: Run, b: BlockContext, length: Callable[[], float]) -> Pace:
    """How feed moves of a length together run; the length counts in G93."""
    if run.modal.feed_mode != INVERSE_TIME:
        return run.path.pace(b)
    if "F" not in b.words:
        raise b.fault("E222", detail="F missing in G93")
    return replace(run.path.pace(b), feed_upm=b.words["F"] * length())


def _arc(run: Run, b: BlockContext, direction: int) -> None:
    check_words(run, b, _LENGTHS + _TURNS.letter)
    path, modal = run.path, run.modal
    plane, end = modal.plane_axes, path.end(b)
    lengths = {word: path.length(b.words[word]) for word in _LENGTHS if word in b.words}
    epsilon = run.cells.read(EPSILON)
    arc = arcs.arc_geometry(b, plane, path.program, end, direction, modal.centres, epsilon, lengths)
    check_radii(run, b, arc, Words(plane, path.program, end, lengths))
    arc = arcs.placed(b, arc, plane, path.coordinates, path.program).with_turns(_turns(b))
    path.arc(b, end, arc, _pace(run, b, end, arc))


def _turns(b: BlockContext) -> int:
    """P of an arc, unless another code of the block takes it."""
    if "P" not in b.words or "P" in b.plan.taken:
        return 1
    check_limit(_TURNS, b.words["P"], b.plan.column("P"))
    return b.whole("P")


def clockwise(run: Run, b: BlockContext) -> None:
    """G2."""
    _arc(run, b, CLOCKWISE)


def counter_clockwise(run: Run, b: BlockContext) -> None:
    """G3."""
    _arc(run, b, COUNTER_CLOCKWISE)


def no_motion(run: Run, b: BlockContext) -> None:
    """Axis words without an active motion."""
    polar = [word for word in run.dialect.grammar.polar if word in b.words]
    words = [*(letter for _, letter in b.plan.axes), *b.plan.modal_words, *polar]
    raise meaningless(run, b, words[0])


MOTIONS: Motions = {
    0: rapid,
    1: line,
    2: clockwise,
    3: counter_clockwise,
    NO_MOTION: no_motion,
}
