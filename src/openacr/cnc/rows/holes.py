"""Rows of canned cycles; lengths are in default units."""

from openacr.cnc.rows import modes, points
from openacr.cnc.rows.moves import AXES
from openacr.cnc.rows.room import Room
from openacr.cnc.rows.scans import LETTERS

_room = Room(points.SIZE)
DRILLING = 5
drilling = _room.reals(DRILLING)  # the words of a cycle:
initial_u, level_u, bottom_u, peck, rest_s = drilling  # peck: active unit
clear_u = _room.reals(2)  # retract of G73, clearance of G83
sign = _room.reals(2)  # of the shift along the first and second axis
spin = _room.real()  # how the spindle turns
kept_position_u = _room.reals(AXES)  # from before the block
kept_target_u = _room.reals(AXES)
kept_drilling = _room.reals(DRILLING)
kept_word = _room.reals(LETTERS)  # of the block, while the text of its cycle is executed
rises = _room.whole()  # cycles go up to R first
stroke = _room.wholes(modes.CYCLES)  # texts in `plans`, from G73 on; 0 none
SIZE = _room.end
