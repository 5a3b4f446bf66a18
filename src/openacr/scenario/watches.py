"""The engine watches for a condition, so that it need not be evaluated in every tick.

A watch fires whenever the condition may have become true or false; the caller (`Play.step`)
evaluates it. A condition that cannot change needs no watch.
"""

from collections.abc import Iterator

from openacr.engine.watches import Watch, Watched, parameter_place
from openacr.map.memory import Memory, flag_place
from openacr.map.rows import axes, system, threads
from openacr.map.words import pf
from openacr.scenario.schema import Condition

_STATES = (
    pf.PAUSE_MODE_WAITING
    | pf.BLOCK_MODE_WAITING
    | pf.PROGRAM_DWELLING
    | pf.PROGRAM_INHIBITED
    | pf.PROGRAM_RUNNING
)


def watches(condition: Condition, memory: Memory) -> Iterator[Watch]:
    """List the watches that decide a condition; printed texts are captured, not watched."""
    if condition.bit is not None:
        yield Watch(Watched.WORD, *flag_place(condition.bit))
    elif condition.program is not None:
        yield Watch(Watched.WORD, pf.word[condition.program], _STATES)
        yield Watch(Watched.WORD, threads.error[condition.program])
    elif condition.axis is not None:
        yield from _bounds(condition, Watched.AXIS, axes.parameters[condition.axis])
    elif condition.parameter is not None:
        yield from _parameter(condition, condition.parameter, memory)


def _parameter(condition: Condition, number: int, memory: Memory) -> Iterator[Watch]:
    found = parameter_place(memory, number)
    if found is None:
        return
    place, row = found
    if place is Watched.FP64:
        # A user variable exists as soon as enough of them are dimensioned.
        yield Watch(Watched.WORD, system.p_count)
    yield from _bounds(condition, place, row)


def _bounds(condition: Condition, place: Watched, row: int) -> Iterator[Watch]:
    if condition.above is not None:
        yield Watch(place, row, bound=condition.above)
    if condition.below is not None:
        yield Watch(place, row, bound=condition.below, is_above=False)
