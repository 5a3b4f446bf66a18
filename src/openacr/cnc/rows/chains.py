"""Rows of a compensated chain (`compensation/chain_cy.py`), in a memory of its own."""

from openacr.cnc.rows.moves import AXES, CURVE, ROW
from openacr.cnc.rows.room import Room

COLUMNS = 36  # doubles of a piece (`compensation/curve_cy.py`)
SLOTS = 64  # more than the pieces that are not issued yet, and those left out between them
SCRATCH_CNT = 3  # rows of the search for the largest radius
MOST_WAITING = 8

# A piece: the row of its element (`moves`), then
FITS = 8
MEETS = 9  # how the next piece follows
IS_LEAD_IN = 10
LEFT_OUT = 11  # elements left out after it
HOLDS = 12  # entries wait for its end
TAG = 13  # the element it was made of; below 0 it is known
PIECE = 14

OUT_ROOM = 128  # rows of all pieces of a chain
MOST_OUT = 1024
EXTRA = 5  # of what is issued: start in the plane, radius of the tool, centre

_room = Room()
column = _room.reals(COLUMNS * (SLOTS + SCRATCH_CNT))  # of all pieces, a row each
# Settings.
away_u = _room.real()  # of the elements to come
epsilon_u = _room.real()
sweep_epsilon_rad = _room.real()
root_u2 = _room.real()
at_u = _room.reals(AXES)  # where the contour has come to
shift_u = _room.reals(AXES)  # from program to machine
# The move that is issued next, in the plane.
start_x, start_y, end_x, end_y, centre_x, centre_y, sweep_rad = _room.reals(7)
# What is not issued yet, the oldest first.
piece_cnt = _room.whole()
waiting = _room.wholes(MOST_WAITING)  # slots of its pieces
next_slot = _room.whole()  # the one that is filled next
last_slot = _room.whole()  # the one issued last, or -1
most_waiting = _room.whole()
has_news = _room.whole()  # there is something to report with the next element
is_inside = _room.whole()  # an element before the next one was left out
element = _room.whole()  # the number of the one in work
found = _room.whole()  # what comp_lay found
tag = _room.whole()  # added to the number of an element
piece = _room.wholes(SLOTS * PIECE)
# What was issued.
out_cnt = _room.whole()
out_row = _room.wholes(MOST_OUT * ROW)
out_end_u = _room.reals(MOST_OUT * AXES)
out_arc = _room.reals(MOST_OUT * CURVE)
out_extra = _room.reals(MOST_OUT * EXTRA)
SIZE = _room.end
