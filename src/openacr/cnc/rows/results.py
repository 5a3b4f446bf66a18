"""Rows of what comes out of lines that are executed together (`moves`)."""

from openacr.cnc.rows import values
from openacr.cnc.rows.moves import CURVE, POINT, ROW
from openacr.cnc.rows.plans import MOST_STEPS
from openacr.cnc.rows.room import Room
from openacr.cnc.rows.runs import MOST_ROWS

ROOM = MOST_ROWS + MOST_STEPS

_room = Room(values.SIZE)
end_u = _room.reals(ROOM * POINT)  # of the machine
arc = _room.reals(ROOM * CURVE)
feed_upm = _room.reals(ROOM + 1)  # of each pace
row = _room.wholes(ROOM * ROW)
SIZE = _room.end
