"""The time of moves: TMOV, and the time base of a master: TOV, SRC."""

from __future__ import annotations

from functools import partial

from openacr.basic.commands.value_commands import value_text
from openacr.basic.commands.velocity_profile import GROUP, REF
from openacr.basic.language import registry
from openacr.basic.language.grammar import Either, Num, ObjectRef, Source, Word
from openacr.basic.language.registry import BY_OBJECT
from openacr.basic.vm.run import Run
from openacr.map.rows import masters
from openacr.motion.axis.settings import fp32, not_negative
from openacr.motion.sources import time_base

command = partial(registry.command, group=GROUP, ref=REF)

TIME = fp32(masters.move_time, not_negative)
FACTOR = fp32(masters.time_over_velocity, not_negative)


@command(
    "TMOV",
    levels=BY_OBJECT,
    grammar=(Either(Word("ON", "OFF"), Num("seconds"), optional=True),),
    units="s",
    default="0",
    saved=True,
)
def tmov(run: Run, given: str | float | None) -> None:
    """Set the time every move takes, never faster than the other values allow; 0 or OFF ends it."""
    master = run.master()
    if given is None:
        run.print(value_text(TIME, TIME.read(run.card, master)))
    elif isinstance(given, str):
        time_base.switch_move_time(run.card, master, on=given == "ON")
    else:
        TIME.check(given)
        time_base.set_move_time(run.card, master, given)


@command(
    "TOV",
    levels=BY_OBJECT,
    grammar=(Either(Word("ON", "OFF"), Num("factor"), optional=True),),
    default="1",
)
def tov(run: Run, given: str | float | None) -> None:
    """Multiply the pace of the time base, 0 to 2: speeds scale with it, the path stays."""
    master = run.master()
    if given is None:
        run.print(value_text(FACTOR, FACTOR.read(run.card, master)))
    elif isinstance(given, str):
        time_base.switch_factor(run.card, master, on=given == "ON")
    else:
        time_base.set_factor(run.card, master, given)


@command("SRC", levels=BY_OBJECT, grammar=(Source(optional=True),), default="CLK", saved=True)
def src(run: Run, source: ObjectRef | None) -> None:
    """Set the time base of moves: 1000 pulses of the source are one second."""
    master = run.master()
    if source is None:
        run.print(time_base.source_text(run.card, master))
    else:
        time_base.set_source(run.card, master, source.word, source.number)
