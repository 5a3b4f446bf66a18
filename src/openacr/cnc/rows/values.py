"""Rows of formulas and assignments (`values_cy`), parameters and jumps."""

from openacr.cnc.rows import plans
from openacr.cnc.rows.moves import AXES
from openacr.cnc.rows.room import Room

MOST_OPERANDS = 32
MOST_VALUES = 16
MOST_UNDO = 4096
UNDO = 3  # numbers of what is taken back: place, value and state
PLACE_OWN = 100  # places: below those of locals, then from here on #n, then
PLACE_CELL = 10000  # cells
CELLS = 4096  # of programs
LOCALS = 33  # of acromill
OWN_LOCALS = 30
LAST_OWN = 5000  # that programs may write
OWN = 6000

STORE_CELL = 0  # kinds of parameters that are assigned
STORE_HASH = 1  # the local, or outside calls the cell
STORE_OWN = 2

IS_KNOWN = 1  # state of a cell
IS_WRITTEN = 2
MAY_READ = 1  # access to a cell
MAY_WRITE = 2

JUMPS = 64
JUMP_MASK = 63
JUMP = 5  # numbers of a jump:
JUMP_LINE = 0
JUMP_PLACE = 1  # its target in the text
JUMP_TARGET = 2  # and its line
JUMP_PASSES = 3
JUMP_IS_KEPT = 4  # 1 if the place of a pass is kept

_room = Room(plans.SIZE)
stack = _room.reals(MOST_OPERANDS)
slot = _room.reals(MOST_VALUES)  # values of the block
undo = _room.reals(UNDO * MOST_UNDO)  # what its assignments replaced
local = _room.reals(LOCALS + 1)  # #1 and up of the call in force; the first is 1 inside a call
own = _room.reals(OWN)  # numbered parameters of the rs274ngc dialect
kept_u = _room.reals(JUMPS * AXES)  # where the machine was in the pass of a jump that is kept
undo_cnt = _room.whole()
access = _room.wholes(CELLS)  # what a program may do with a cell
jump = _room.wholes(JUMPS * JUMP)  # jumps by their line
SIZE = _room.end
