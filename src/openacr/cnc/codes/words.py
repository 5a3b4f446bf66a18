"""F, S, T, D, H: words that act by themselves."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from openacr.cnc.canonical import Entry, SetCell, Spin, Spindle, Transfer
from openacr.cnc.codes.fast import Does
from openacr.cnc.codes.table import Limit, Step
from openacr.cnc.codes.tables import ACROMILL
from openacr.cnc.reading.findings import CodeError
from openacr.cnc.reading.formulas import Formula
from openacr.cnc.state.cells import (
    LAST_LENGTH,
    LAST_RADIUS,
    LENGTH,
    LENGTH_WEAR,
    LENGTH_WEARS,
    LENGTHS,
    RADII,
    RADIUS,
    RADIUS_WEAR,
    RADIUS_WEARS,
    TOOL,
)
from openacr.cnc.state.modal import INVERSE_TIME
from openacr.cnc.state.parameters import number

if TYPE_CHECKING:
    from openacr.cnc.codes.run import Run
    from openacr.cnc.program.block_context import BlockContext

letter = ACROMILL.letter
LAST_VARIABLE, LAST_SET_UP = 4095, 99  # of the card; those the set-up makes


@letter("F", step=Step.FEED, fast=Does.TAKES_FEED)
def feed(run: Run, b: BlockContext) -> None:
    """Feed in active units per minute."""
    if b.words["F"] <= 0.0:
        raise b.fault("E222", "F", f"F{b.words['F']:g}", "the feed is above 0")
    if run.modal.feed_mode == INVERSE_TIME:
        return  # moves per minute, of this block alone
    run.modal.feed = run.path.length(b.words["F"])
    run.modal.has_feed = True
    run.path.change_pace()


@letter("S", step=Step.SPEED, limits=(Limit("S", 0, 1e6, "E222"),), fast=Does.SHOWS)
def speed(run: Run, b: BlockContext) -> None:
    """Spindle speed in turns per minute; acts at once while the spindle turns."""
    run.modal.speed = b.words["S"]
    if run.modal.spin is not Spin.OFF and not run.options.is_dry:
        run.tell(Spindle(b.source, run.modal.spin, run.modal.speed, is_awaited=False))


@letter("T", step=Step.TOOL, limits=(Limit("T", 0, 999, "E222", is_whole=True),), fast=Does.SHOWS)
def tool(run: Run, b: BlockContext) -> None:
    """Tool for the next M6."""
    run.modal.tool = b.whole("T")
    run.tell(SetCell(b.source, TOOL, run.modal.tool))


@letter("T#", step=Step.TRANSFER)
def transfer(run: Run, b: BlockContext) -> Iterator[Entry]:
    """`T Pn`: the card variable Pn gets the value of parameter n."""
    yield from run.sync(b.source)
    word = b.plan.words["T"]
    if word.parameter is None:
        raise b.fault("E105", "T")
    n = number(Formula(word.parameter, run.parameters).now())
    if not 0 <= n <= LAST_VARIABLE:
        hint = f"variables of the card are P0 to P{LAST_VARIABLE}"
        raise CodeError("E211", word.column, f"T P{n}", hint)
    error = run.cells.home(n).write_error()
    if error:
        raise CodeError(error, word.column, f"T P{n}")
    if n > LAST_SET_UP:
        run.warn(b, "W406", "T", f"T P{n}")
    run.tell(Transfer(b.source, n, run.parameters.read_p(n)))


@letter(
    "D",
    step=Step.RADIUS,
    limits=(Limit("D", 0, LAST_RADIUS, "E222", is_whole=True),),
    fast=Does.SHIFTS,
)
def radius(run: Run, b: BlockContext) -> None:
    """Cutter radius and its wear by number; D0 is radius 0."""
    select_radius(run, b.whole("D"))


def select_radius(run: Run, n: int) -> None:
    """Copy radius n and its wear to the cells in use."""
    run.modal.radius_number = n
    with run.cells.transaction(is_durable=False):
        run.parameters.store(RADIUS, run.cells.read(RADII + n) if n else 0.0)
        run.parameters.store(RADIUS_WEAR, run.cells.read(RADIUS_WEARS + n) if n else 0.0)


@letter(
    "H",
    step=Step.LENGTH_NUMBER,
    limits=(Limit("H", 0, LAST_LENGTH, "E222", is_whole=True),),
    fast=Does.SHIFTS,
)
def length(run: Run, b: BlockContext) -> None:
    """Tool length and its wear by number; without G43 or G44 it switches G43 on."""
    select_length(run, b.whole("H"))
    if run.modal.length == 49 and b.whole("H"):
        run.modal.length = 43
    run.path.refresh()


def select_length(run: Run, n: int) -> None:
    """Copy length n and its wear to the cells in use."""
    run.modal.length_number = n
    with run.cells.transaction(is_durable=False):
        run.parameters.store(LENGTH, run.cells.read(LENGTHS + n) if n else 0.0)
        run.parameters.store(LENGTH_WEAR, run.cells.read(LENGTH_WEARS + n) if n else 0.0)
