"""Rows of a run of lines that are executed together."""

from openacr.cnc.rows import holes
from openacr.cnc.rows.moves import AXES
from openacr.cnc.rows.room import Room

MOST_ROWS = 8192  # moves and notes of one run
MOST_IDLE = 100_000  # blocks without motion, dwell or wait

# What became of a block.
TAKEN = 0
LEFT = 2  # to the parser
JUMPED = 3
CALLED = 4  # it is executed again after a handler has been called

_room = Room(holes.SIZE)
letter_of = _room.wholes(AXES)  # the letter of each axis, A is 0
first_at = _room.whole()  # place of the data in the text
first_line = _room.whole()
is_shifted = _room.whole()  # the machine is not where the program is
is_plain = _room.whole()  # only straight feed moves of one pace are taken
has_values = _room.whole()  # cells can be read and written here
most_passes = _room.whole()  # of a jump; 0: jumps are not counted
has_turned = _room.whole()  # the spindle is switched by a note
jump_cnt = _room.whole()
# The line in work.
line = _room.whole()
line_start = _room.whole()
line_stop = _room.whole()
line_text = _room.whole()  # 0 the program, 1 the cycles
call = _room.whole()  # the note of the handler that is to be called
call_cnt = _room.whole()  # handlers the block has come to
called_cnt = _room.whole()  # handlers that have been called for the line
SIZE = _room.end
