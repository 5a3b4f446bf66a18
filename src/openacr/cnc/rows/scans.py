"""Rows of reading lines (`reading/scan_cy.py`, `rich_cy.py` beside it) and of known shapes."""

from openacr.cnc.rows.room import Room

LETTERS = 26
MOST_TOKENS = 32  # of a plain line
MOST_RICH = 128  # tokens of a line with formulas
MOST_NUMBERS = 32  # of the formulas of a line
CYCLE_NUMBERS = 256  # of the texts of all cycles
SLOTS = 1024
SLOT = 3  # numbers of a slot:
SLOT_FIRST = 0  # the place of its first token
SLOT_COUNT = 1  # of tokens, 0 where it is free
SLOT_MEANING = 2
SHAPE_TOKENS = 37888  # of all shapes

# Why no more lines were read.
AT_END = 0  # the data, or the room for results, ends
HARD = 1  # a line that is not plain
NEW = 2  # a shape that is not known
SLOW = 3  # a shape that is left to the parser
LEFT = 4  # a line the caller leaves to the parser for its values
CALLED = 5  # a line that is executed after a handler has been called

NO_SHAPE = -2  # meanings of a shape, besides those of the caller
SLOW_SHAPE = -1

_room = Room()

# Of the line read last.
value = _room.real()  # the number read last
word = _room.reals(LETTERS)  # values of words by letter, A is 0
number = _room.reals(MOST_NUMBERS + CYCLE_NUMBERS)  # of its formulas in order, then of the cycles
label = _room.whole()  # N where it names a line, 0 none
token_cnt = _room.whole()
token_hash = _room.whole()
number_cnt = _room.whole()
token = _room.wholes(MOST_RICH)
number_at = _room.wholes(MOST_NUMBERS)  # where each number is in the line

# Of the language and the machine.
rotary_axes = _room.whole()  # mask of the axes that have no unit
bracket = _room.whole()  # what opens an expression

# Of all lines that were read together.
next_at = _room.whole()  # offset of the first line that was not read
next_line = _room.whole()  # and its number
last_at = _room.whole()  # offset of the last line that was read
last_line = _room.whole()  # and its number
status = _room.whole()
line_cnt = _room.whole()
label_cnt = _room.whole()
motion = _room.whole()  # tenths: the last of G0 to G3, -1 none
has_words = _room.whole()  # whether a line had words

slot = _room.wholes(SLOT * SLOTS)  # what is known of shapes
shape_token = _room.wholes(SHAPE_TOKENS)
SIZE = _room.end
