"""Synchronised masters: SYNC."""

from __future__ import annotations

from functools import partial

from openacr.basic.commands.velocity_profile import GROUP, REF
from openacr.basic.language import registry
from openacr.basic.language.grammar import Object, ObjectRef, Repeat
from openacr.basic.language.registry import PROG
from openacr.basic.vm.run import Run
from openacr.motion.path import synchronism

command = partial(registry.command, group=GROUP, ref=REF)

MASTERS = Repeat(Object("MASTER"))


@command("SYNC", levels=PROG)
def sync(run: Run) -> None:
    """Report the synchronised masters."""
    found = synchronism.members(run.card)
    run.print(" ".join(f"MASTER{master}" for master in found) or "OFF")


@command("SYNC ON", levels=PROG, grammar=(MASTERS,))
def sync_on(run: Run, masters: tuple[ObjectRef, ...]) -> None:
    """Let the moves of masters begin in the same servo period and end together."""
    synchronism.join(run.card, (master.number for master in masters))


@command("SYNC OFF", levels=PROG, grammar=(Repeat(Object("MASTER"), optional=True),))
def sync_off(run: Run, masters: tuple[ObjectRef, ...] | None) -> None:
    """Let masters, or all of them, be independent again."""
    chosen = synchronism.members(run.card) if masters is None else [m.number for m in masters]
    synchronism.leave(run.card, chosen)


@command("SYNC PROG", levels=PROG, default="PROG")
def sync_prog(run: Run) -> None:
    """Let synchronised moves begin when every master has one."""
    synchronism.set_manual(run.card, manual=False)


@command("SYNC MDI", levels=PROG)
def sync_mdi(run: Run) -> None:
    """Let synchronised moves wait for a cycle start of any of the masters as well."""
    synchronism.set_manual(run.card, manual=True)
