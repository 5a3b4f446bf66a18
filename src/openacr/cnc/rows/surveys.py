"""Rows of what is added up over moves (`interpreter/survey_cy.py`), in a memory of their own."""

from openacr.cnc.rows.moves import AXES
from openacr.cnc.rows.room import Room

_room = Room()
low_u = _room.reals(AXES)  # extents
high_u = _room.reals(AXES)
at_u = _room.reals(AXES)  # the present point
rapid_u = _room.real()  # lengths
feed_u = _room.real()
rapid_cnt = _room.whole()
feed_cnt = _room.whole()
arc_cnt = _room.whole()
axes = _room.whole()  # masks: of the machine
linear_axes = _room.whole()
unplaced_axes = _room.whole()  # did not move yet
SIZE = _room.end
