"""The fast form of a code: what it comes down to where many blocks are executed at once.

Blocks are executed at once (`cnc.interpreter.lines_cy`) while no scaling, rotation, modal macro or
inverse time is on. Under these conditions the handler of a code with a
fast form does exactly what the form says; a block with any other code is left to the handlers.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum, auto

from msgspec import Struct


class Does(Enum):
    """What is more than a value of the modal state."""

    NOTHING = auto()
    TAKES_FEED = auto()  # F
    MOVES = auto()  # as the motion or cycle in force
    DRILLS = auto()  # begins or changes a cycle
    ENDS_CYCLE = auto()
    # The handler neither reads nor changes what the core executes, and only hands out entries: it
    # is called in its place between the moves, when these become entries.
    SHOWS = auto()
    TURNS = auto()  # the same for the spindle: a cycle after it is left, it knows how that turned
    RESTS = auto()  # an entry that waits: what follows is no longer idle
    # The handler changes offsets and what the core does not know of the modal state, hands out
    # nothing, and does the same when it is called twice: it is called before its block is executed,
    # unless compensation is on, or a word is missing that it takes.
    SHIFTS = auto()


class Sets(Struct, frozen=True):
    """A field of the modal state gets a value, without `value` the number of the code.

    With `is_alone` the moves before and after a change differ in more than their ends. With
    `is_barred` no cycle is active and no compensation is on. `compensation` is not changed: it has
    that value.
    """

    field: str
    value: int | None = None
    is_alone: bool = False
    is_barred: bool = False


Fast = Does | Sets
Forms = tuple[Fast, ...]  # one after another
FastForms = Fast | Forms | Mapping[float, Fast | Forms]  # for all codes of a handler, or by number


def forms_of(forms: FastForms | None, number: float) -> Forms | None:
    """The fast forms of one code; None where only its handler knows what it does."""
    found = forms.get(number) if isinstance(forms, Mapping) else forms
    return found if found is None or isinstance(found, tuple) else (found,)
