"""Synchronised masters: SYNC."""

from __future__ import annotations

from openacr.basic.commands.velocity_profile import GROUP, REF
from openacr.basic.language.grammar import Object, ObjectRef, Repeat
from openacr.basic.language.registry import PROG, command
from openacr.basic.vm.run import Run
from openacr.motion.path import synchronism

MASTERS = Repeat(Object("MASTER"))


@command("SYNC", group=GROUP, levels=PROG, ref=REF)
def sync(run: Run) -> None:
    """Report the synchronised masters."""
    found = synchronism.members(run.card)
    run.print(" ".join(f"MASTER{master}" for master in found) or "OFF")


@command("SYNC ON", group=GROUP, levels=PROG, grammar=(MASTERS,), ref=REF)
def sync_on(run: Run, masters: tuple[ObjectRef, ...]) -> None:
    """Let the moves of masters begin in the same servo period and end together."""
    synchronism.join(run.card, (master.number for master in masters))


@command(
    "SYNC OFF",
    group=GROUP,
    levels=PROG,
    grammar=(Repeat(Object("MASTER"), optional=True),),
    ref=REF,
)
def sync_off(run: Run, masters: tuple[ObjectRef, ...] | None) -> None:
    """Let masters, or all of them, be independent again."""
    chosen = synchronism.members(run.card) if masters is None else [m.number for m in masters]
    synchronism.leave(run.card, chosen)


@command("SYNC PROG", group=GROUP, levels=PROG, ref=REF, default="PROG")
def sync_prog(run: Run) -> None:
    """Let synchronised moves begin when every master has one."""
    synchronism.set_manual(run.card, manual=False)


@command("SYNC MDI", group=GROUP, levels=PROG, ref=REF)
def sync_mdi(run: Run) -> None:
    """Let synchronised moves wait for a cycle start of any of the masters as well."""
    synchronism.set_manual(run.card, manual=True)
