"""Buffered moves and looking ahead over them: MBUF, LOOK."""

from __future__ import annotations

from functools import partial

from openacr.basic.commands.value_commands import Value, master_values
from openacr.basic.commands.velocity_profile import GROUP, REF
from openacr.basic.language import registry
from openacr.basic.language.grammar import Group, Word
from openacr.basic.language.number_format import number_text
from openacr.basic.language.registry import BY_OBJECT, EXTENSION
from openacr.basic.vm.run import Run, Show, Wait, WaitKind
from openacr.map.rows import masters, storage
from openacr.models import Feature
from openacr.motion.axis.settings import fp32, fp64, not_negative
from openacr.motion.path import buffer, corners

command = partial(registry.command, group=GROUP, ref=REF)


@command("MBUF", levels=BY_OBJECT, grammar=(Word("ON", "OFF", optional=True),))
def mbuf(run: Run, word: str | None) -> Wait | None:
    """Let several moves wait in the buffer, as many as DIM MBUF says or 10; alone, count them."""
    master = run.master()
    if word is None:
        run.print(str(buffer.waiting(run.card, master)))
        return None
    program = run.card.attachments.program(master)
    heap = run.system.storage.heap
    count = 0 if program is None else heap.row(program, storage.mbuf_count)
    moves_ring = word == "OFF" or not buffer.fits(run.card, master, count)
    if moves_ring and not buffer.is_empty(run.card, master):
        row = masters.queued[master]
        return Wait(WaitKind.ROW_BELOW, row, 1, retry=True, show=Show.MOVE_PENDING)
    if word == "ON":
        buffer.switch_on(run.card, master, count)
    else:
        buffer.switch_off(run.card, master)
        if program is not None:
            heap.set_row(program, storage.mbuf_count, 0)
    return None


@command(
    "LOOK",
    levels=BY_OBJECT,
    grammar=(Word("ON", "OFF", optional=True),),
    default="OFF",
    saved=True,
    needs=Feature.LOOK_AHEAD,
)
def look(run: Run, word: str | None) -> None:
    """Look ahead over the buffered moves: merge them, and slow down before corners."""
    master = run.master()
    if word is None:
        run.print("ON" if buffer.looks(run.card, master) else "OFF")
    else:
        buffer.switch_look(run.card, master, on=word == "ON")


@command(
    "LOOK ANG",
    levels=BY_OBJECT,
    grammar=(Group("from", "to", optional=True),),
    units="degrees",
    default="0,90",
    saved=True,
    needs=Feature.LOOK_AHEAD,
)
def look_ang(run: Run, angles: tuple[float, ...] | None) -> None:
    """Set the turns up to which corners are free, and from which on they are slowest."""
    master = run.master()
    if angles is None:
        run.print(",".join(map(number_text, buffer.look_angles(run.card, master))))
    else:
        buffer.set_look_angles(run.card, master, *angles)


master_values(
    (
        Value("LOOK MINVEL", fp32(masters.look_ahead_min_vel, not_negative),
              "Set the speed of the sharpest corners with look-ahead.", "units/s"),
    ),
    group=GROUP,
    ref=REF,
    needs=Feature.LOOK_AHEAD,
)  # fmt: skip

master_values(
    (
        Value("LOOK TOL", fp64(masters.tolerance_u, corners.is_tolerance),
              "Set how far the paths of moves to come may stay off their corners with look-ahead.",
              "units"),
    ),
    group=GROUP,
    ref=EXTENSION,
    needs=Feature.LOOK_AHEAD,
)  # fmt: skip
