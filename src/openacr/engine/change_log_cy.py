"""What changed in which tick: chosen bits of words, and which of chosen numbers moved.

The log is a buffer of the caller, no part of the state: its head, three integers for each word
(place, mask, value seen), three for each number of 64 bits (place, both halves), then entries of
four integers (tick low and high, word or MOVED_WORD, value). A log without room for all that may
change in a tick is left alone: what changes meanwhile is noted when there is room again.
"""

from openacr.map.rows import system
from openacr.views import I32

__all__ = ["changes_note"]

# The head.
WORDS = 0  # words; 0 words: nothing is noted
NUMBERS = 1
ROOM = 2  # entries
NOTED = 3  # entries that are written
MOVED = 4  # a bit for each number that changed in the latest tick; UNKNOWN: none was seen yet
HEAD = 5

PLACE = 3  # integers of a word or number
ENTRY = 4
MOVED_WORD = -1
UNKNOWN = -1


def changes_note(I: I32, log: I32) -> None:
    """Note what has changed since the last call, with the present tick."""
    words: int = log[WORDS]
    if log[NOTED] + words >= log[ROOM]:
        return
    place: int = HEAD
    for word in range(words):
        value: int = I[log[place]] & log[place + 1]
        if value != log[place + 2]:
            log[place + 2] = value
            changes_put(I, log, word, value)
        place += PLACE
    moved: int = 0
    for number in range(log[NUMBERS]):
        row: int = 2 * log[place]
        if I[row] != log[place + 1] or I[row + 1] != log[place + 2]:
            log[place + 1] = I[row]
            log[place + 2] = I[row + 1]
            moved |= 1 << number
        place += PLACE
    if moved != log[MOVED]:
        log[MOVED] = moved
        changes_put(I, log, MOVED_WORD, moved)


def changes_put(I: I32, log: I32, word: int, value: int) -> None:
    """Write an entry."""
    cell: int = HEAD + PLACE * (log[WORDS] + log[NUMBERS]) + ENTRY * log[NOTED]
    log[cell] = I[system.tick_low]
    log[cell + 1] = I[system.tick_high]
    log[cell + 2] = word
    log[cell + 3] = value
    log[NOTED] += 1
