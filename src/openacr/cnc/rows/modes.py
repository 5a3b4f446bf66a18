"""Rows of the modal state, and what else is restored where a line is left."""

from openacr.cnc.rows import scans
from openacr.cnc.rows.room import Room

INCREMENTAL = 91
INCH = 20
RETURN_R = 99
NO_CYCLE = 80
OFF = 40  # compensation
FIRST_CYCLE = 73
PECK_BREAK = 73
PECK = 83
CYCLES = 18  # from the first one on

WRITTEN = 1  # forms of R and Z of a cycle; 0: not written
INCREMENTS = 2
HAS_PECK = 1  # words of a cycle
HAS_REST = 2

_room = Room(scans.SIZE)
FIELDS = 9  # of the modal state, in the order of `fast_plans.FIELDS`
STATE = FIELDS + 8
state = _room.wholes(STATE)  # what is restored where a line is left:
(
    motion,
    plane,
    distance,
    centres,
    unit,
    return_level,
    path,
    cycle,
    compensation,
    pace,  # of the next move
    has_feed,
    idle_cnt,  # blocks since the last move
    move_cnt,  # moves and notes
    is_drilling,  # whether there are words of a cycle
    level_form,
    bottom_form,
    cycle_words,
) = state
kept = _room.wholes(STATE)  # the same from before the line
SIZE = _room.end
