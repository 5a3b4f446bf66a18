"""Numbers of store cells that several modules of the interpreter read or write."""

# System parameters.
CMP_RAD = 100_020  # radius of programs without D
START_FEED = 100_021  # RUN SETUP FEEDRATE, 0: Cut Speed
DEFAULT_UNIT = 250_001  # 0 inch, 1 mm
LIBRARY_CENTRES = 250_004  # reading of I, J, K in library parts
SPIRALS = 250_131  # arcs of any two radii are meant
EPSILON = 250_101  # for compensation; ends nearer than this are one
CUT_SPEED = 650_002
HASH_TEST = 700_001
M30_ENDS = 700_002

# Offsets: a table each, then the values in use.
RADII, RADIUS_WEARS, RADIUS, RADIUS_WEAR = 1000, 1500, 1998, 1999
LENGTHS, LENGTH_WEARS, LENGTH, LENGTH_WEAR = 2000, 3000, 4000, 4001
LAST_RADIUS, LAST_LENGTH = 400, 999
COMMON, LOCAL, FLOATING, FIXTURES = 900, 990, 801, 952_000  # of axis 0

# What is shown of the state.
TOOL, TOOL_IN_SPINDLE, SPEED, SPIN, COOLANT = 234, 235, 238, 240, 241
