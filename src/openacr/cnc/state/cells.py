"""Store cells that several modules of the interpreter read or write, bound once as numbers."""

from openacr.sysvar.tabs import CELLS, COMPATIBILITY, CONTROL, GENERAL, OFFSETS, SPEEDS
from openacr.sysvar.tabs.cells import LENGTH_OFFSETS, RADIUS_OFFSETS

# System parameters.
CMP_RAD = GENERAL.cmp_rad  # radius of programs without D
START_FEED = GENERAL.run_setup_feedrate  # 0: Cut Speed
DEFAULT_UNIT = CONTROL.default_units  # 0 inch, 1 mm
LIBRARY_CENTRES = CONTROL.lib_part_ij_inversion  # reading of I, J, K in library parts
SPIRALS = CONTROL.spirals_allowed  # arcs of any two radii are meant
EPSILON = CONTROL.epsilon_for_compensation  # ends nearer than this are one
CUT_SPEED = SPEEDS.cut_speed
HASH_TEST = COMPATIBILITY.hash_input_test
M30_ENDS = COMPATIBILITY.m30_ends_program

# Offsets: a table each by its first cell, then the values in use.
RADII, RADIUS_WEARS = CELLS.d_radius[0], CELLS.d_wear[0]
RADIUS, RADIUS_WEAR = CELLS.current_d_radius, CELLS.current_d_wear
LENGTHS, LENGTH_WEARS = CELLS.h_length[0], CELLS.h_wear[0]
LENGTH, LENGTH_WEAR = CELLS.current_h_length, CELLS.current_h_wear
LAST_RADIUS, LAST_LENGTH = RADIUS_OFFSETS, LENGTH_OFFSETS
# Of axis 0.
COMMON, LOCAL = CELLS.common_work_shift[0], CELLS.local_shift[0]
FLOATING = CELLS.floating_zero_shift[0]
FIXTURES = OFFSETS.fixtures[0][0] - OFFSETS.fixtures[0].step  # of G100, which has no cells

# What is shown of the state.
TOOL, TOOL_IN_SPINDLE = CELLS.tool_selected, CELLS.tool_in_spindle
