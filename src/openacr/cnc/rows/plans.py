"""Rows of plans: what lines of a shape do, as numbers that are made once by Python.

A plan is its head, then steps of three numbers, then the codes of its formulas; the text of a
cycle is the count of its lines, then for each line STROKE numbers.
"""

from openacr.cnc.rows import runs
from openacr.cnc.rows.room import Room

MOST_PLANNED = 32768  # numbers of all plans
MOST_STEPS = 32
MOST_LIMITS = 24
LIMIT = 3  # numbers of a limit: low, high, 1 if whole

AXES = 0  # axes named (mask)
WORDS = 1  # I J K R Q P L (mask 1 2 4 ...)
IS_PLAIN = 2
STEP_CNT = 3
STEPS = 4

STEP_SET = 0  # row, value
STEP_UNIT = 1  # as STEP_ALONE, and the factors of the unit
STEP_FEED = 2
STEP_MOVE = 3
STEP_WORD = 4  # letter, formula
STEP_VALUE = 5  # slot, formula
STEP_STORE = 6  # kind, slot
STEP_JUMP = 7  # JUMP_..., formula or 0
STEP_BAR = 8  # row, value: left in a cycle and under compensation, unless it is so already
STEP_DRILL = 9  # code
STEP_END_CYCLE = 10
STEP_NOTE = 11  # number of the note, letters of its words: count, then each; a wait
STEP_LIMIT = 12  # letter, limit
STEP_GO = 13  # in a cycle: line, formula or 0
STEP_RETURN = 14  # in a cycle: -, formula or 0
STEP_SHOW = 15  # as STEP_NOTE, no wait
STEP_KEEP = 16  # row, value: left, unless it is so already
STEP_TURN = 17  # as STEP_SHOW, of the spindle
STEP_ALONE = 18  # row, value: left after moves, unless it is so already
STEP_CALL = 19  # number of the note, whose handler is called before the block is executed
JUMP_COUNTS = 1
JUMP_IF_TRUE = 2  # else where it is false

LETTER_F = 5
LETTER_I = 8
LETTER_L = 11
LETTER_P = 15
LETTER_Q = 16
LETTER_R = 17
LETTER_X = 23
CENTRE_BITS = 7
BIT_R = 8
ARC_BITS = 15
BIT_Q = 16
BIT_P = 32
BIT_L = 64

STROKE = 4  # plan, number, begin and end of a line of a cycle
MOST_STROKE = 4096  # lines executed at a hole
MOST_REPEATS = 9999.0
RETURNED = -1  # for the next line of a cycle
CUT_SHORT = -2

_room = Room(runs.SIZE)
limit = _room.reals(LIMIT * MOST_LIMITS)
number = _room.wholes(MOST_PLANNED)
SIZE = _room.end
