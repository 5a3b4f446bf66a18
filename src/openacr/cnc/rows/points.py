"""Rows of points, units and feed; lengths are in default units."""

from openacr.cnc.rows import arcs, modes
from openacr.cnc.rows.moves import AXES
from openacr.cnc.rows.room import Room

_room = Room(modes.SIZE)
position_u = _room.reals(AXES)  # of the program
target_u = _room.reals(AXES)  # of the machine
shift_u = _room.reals(AXES)  # from one to the other
end_u = _room.reals(AXES)  # the point of the program a block goes to
goal_u = _room.reals(AXES)  # and that of the machine
times = _room.real()  # active unit to default unit: times / per
per = _room.real()
factor = _room.reals(4)  # times and per of G20, then of G21
feed_upm = _room.real()
kept_times = _room.real()  # the same from before the line
kept_per = _room.real()
kept_feed_upm = _room.real()
near_u = _room.real()  # radii are equal within it
epsilon_u = _room.real()  # a chord may be longer than two radii by it
arc = _room.reals(arcs.SIZE)  # one arc (`arcs`)
SIZE = _room.end
