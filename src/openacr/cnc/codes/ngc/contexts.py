"""M70 to M73: the modal state of a call, kept and restored."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from openacr.cnc.canonical import Coolant, Entry, Spindle
from openacr.cnc.codes.active import Context
from openacr.cnc.codes.gcodes.work import select
from openacr.cnc.codes.table import Step
from openacr.cnc.codes.tables import RS274NGC
from openacr.cnc.codes.words import select_length
from openacr.cnc.reading.findings import CodeError

if TYPE_CHECKING:
    from openacr.cnc.canonical import Source
    from openacr.cnc.codes.run import Run
    from openacr.cnc.program.block_context import BlockContext
    from openacr.cnc.state.modal import Modal

mcode = RS274NGC.mcode
FIELDS = (
    "plane distance unit length return_level path tolerance centres feed feed_mode has_feed speed"
    " spin mist flood is_feed_locked"
).split()
_SPINDLE, _COOLANT = ("spin", "speed"), ("mist", "flood")


@mcode(70, step=Step.KEEP)
def keep(run: Run, b: BlockContext) -> None:
    """Keep the modal state of this call for M72; motion, tool and parameters are no part of it."""
    run.o_words.context = _kept(run, is_automatic=False)


@mcode(73, step=Step.KEEP)
def keep_for_return(run: Run, b: BlockContext) -> None:
    """As M70; the end of the subroutine restores it."""
    run.o_words.context = _kept(run, is_automatic=True)


@mcode(71, step=Step.KEEP)
def forget(run: Run, b: BlockContext) -> None:
    """Forget what M70 or M73 kept."""
    run.o_words.context = None


@mcode(72, step=Step.KEEP)
def restore(run: Run, b: BlockContext) -> Iterator[Entry]:
    """Restore the modal state that M70 or M73 kept in this call."""
    context = run.o_words.context
    if context is None:
        raise b.fault("E265", hint="M70 or M73 keeps it, in the same call")
    restored(run, context, b.source, b.plan.column(""))
    yield from run.flush()


def _kept(run: Run, *, is_automatic: bool) -> Context:
    return Context(run.modal.copy(), run.path.coordinates.added, is_automatic)


def restored(run: Run, context: Context, source: Source, column: int) -> None:
    """Put the state back, and switch what differs; compensation has to be as it was."""
    modal, kept = run.modal, context.modal
    changes_plane = modal.compensation != 40 and modal.plane != kept.plane
    if modal.compensation != kept.compensation or changes_plane:
        raise CodeError("E311", column, hint="compensation and its plane are not restored")
    spindle, coolant = _values(modal, _SPINDLE), _values(modal, _COOLANT)
    for name in FIELDS:
        setattr(modal, name, getattr(kept, name))
    if modal.work != kept.work:
        select(run, kept.work)
    if modal.length_number != kept.length_number:
        select_length(run, kept.length_number)
    run.path.coordinates.added = context.added
    run.path.set_unit()
    run.path.change_pace()
    run.path.refresh()
    if run.options.is_dry:
        return
    if spindle != _values(modal, _SPINDLE):
        run.tell(Spindle(source, modal.spin, modal.speed))
    if coolant != _values(modal, _COOLANT):
        run.tell(Coolant(source, modal.mist, modal.flood))


def _values(modal: Modal, names: tuple[str, ...]) -> tuple[object, ...]:
    return tuple(getattr(modal, name) for name in names)
