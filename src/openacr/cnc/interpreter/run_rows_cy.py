"""Rows of the arrays in which blocks are executed many at a time.

Each line has a shape (`scan_cy`), and each shape a plan in `P`, made once by Python:

    axes named (mask), I J K R Q P L (mask 1 2 4 ...), PLAIN, ALONE, count of steps, steps of
    3 numbers

`W` and `K` as in `scan_cy`, continued here. `M`: the modal state. `R`: ROW numbers of each move or
note, `ends`: its target, `arcs`: centre, sweep, radii. `A`: one arc (`arc_cy`), then the point a
block goes to.
"""

from openacr.cnc.geometry.arc_cy import A_SIZE
from openacr.cnc.reading.rich_cy import K_RICH_SIZE
from openacr.cnc.reading.scan_cy import AXES, W_SCAN_SIZE

K_LETTER = K_RICH_SIZE  # the letter of each axis
K_LAST_LINE = K_LETTER + AXES  # number of the last line that was read
K_READ = K_LETTER + AXES + 1  # count of lines read
K_FIRST = K_LETTER + AXES + 2  # place of the data in the text
K_JUMPS = K_LETTER + AXES + 3  # count of jumps
K_RUN_SIZE = K_LETTER + AXES + 4

W_POSITION = W_SCAN_SIZE  # program position, default units
W_TARGET = W_POSITION + 8  # machine position
W_SHIFT = W_POSITION + 16  # from one to the other
W_TIMES = W_POSITION + 24  # active unit to default unit
W_PER = W_POSITION + 25
W_UNITS = W_POSITION + 26  # times and per of G20, then of G21
W_FEED = W_POSITION + 30  # in force, default units
W_NEAR = W_POSITION + 31  # radii are equal within it
W_EPSILON = W_POSITION + 32  # a chord may be longer than two radii by it
W_KEPT = W_POSITION + 33  # times, per and feed from before the line
W_INITIAL = W_POSITION + 36  # of the cycle: level where it began
W_LEVEL = W_POSITION + 37  # R
W_BOTTOM = W_POSITION + 38
W_PECK = W_POSITION + 39  # Q
W_REST = W_POSITION + 40  # P
W_SPIN = W_POSITION + 41
W_CLEAR = W_POSITION + 42  # retract of G73, clearance of G83
W_SIGNS = W_POSITION + 44  # of the shift along the first and second axis
W_BEFORE = W_POSITION + 46  # position, target and words of the cycle, from before the block
W_LIMITS = W_POSITION + 67  # low, high, 1 if whole, of words with limits
MOST_LIMITS = 24
W_RUN_SIZE = W_LIMITS + 3 * MOST_LIMITS

# Rows of the modal state, and what belongs to the run.
M_MOTION = 0
M_PLANE = 1
M_DISTANCE = 2
M_CENTRES = 3
M_UNIT = 4
M_RETURN = 5
M_PATH = 6
M_CYCLE = 7
M_COMPENSATION = 8  # the same for all lines
M_FIELDS = 9
M_PACE = 9  # of the next move
M_HAS_FEED = 10
M_IDLE = 11  # blocks since the last move
M_ROWS = 12  # count of moves and notes
M_IS_DRILLING = 13  # whether there are words of a cycle
M_LEVEL = 14  # how R was written: 0 not, WRITTEN or INCREMENTS; then Z
M_BOTTOM = 15
M_WORDS = 16  # HAS_PECK, HAS_REST
M_KEEP = 17  # rows that are restored where a line is left
M_KEPT = 17  # the same from before the line
M_IS_SHIFTED = 34
M_IS_PLAIN = 35  # only straight feed moves of one pace are taken
M_LINE = 36  # of the first line
M_HAS_VALUES = 37  # cells can be read and written here
M_MOST_PASSES = 38  # of a jump; 0: jumps are not counted
M_AT = 39  # of the line in work: number, begin, end, text
M_RISES = 43  # cycles go up to R first
M_STROKES = 44  # places of the texts of cycles in P, from G73 on; 0: left
M_HAS_TURNED = 62  # the spindle is switched by a note
M_SIZE = 63

WRITTEN = 1
INCREMENTS = 2
HAS_PECK = 1
HAS_REST = 2

P_AXES = 0
P_WORDS = 1
P_IS_PLAIN = 2
P_IS_ALONE = 3
P_STEPS = 4
P_FIRST = 5

STEP_SET = 0  # row, value
STEP_UNIT = 1  # the same, and the factors of the unit
STEP_FEED = 2
STEP_MOVE = 3
STEP_WORD = 4  # letter, formula
STEP_VALUE = 5  # slot, formula
STEP_STORE = 6  # kind, slot
STEP_JUMP = 7  # JUMP_..., formula or 0
STEP_BAR = 8  # row, value: left in a cycle and under compensation, unless it is so already
STEP_DRILL = 9  # code
STEP_END_CYCLE = 10
STEP_NOTE = 11  # number of the note, letters of its words: count, then each; a wait
STEP_LIMIT = 12  # letter, limit
STEP_GO = 13  # in a cycle: line, formula or 0
STEP_RETURN = 14  # in a cycle: -, formula or 0
STEP_SHOW = 15  # as STEP_NOTE, no wait
STEP_TURN = 17  # as STEP_SHOW, of the spindle
STEP_KEEP = 16  # row, value: left, unless it is so already
JUMP_COUNTS = 1
JUMP_IF_TRUE = 2  # else where it is false

R_KIND = 0
R_LINE = 1
R_PACE = 2
R_PLANE = 3
R_START = 4  # of its line
R_STOP = 5
R_TEXT = 6  # 0 the program, 1 the cycles
R_FLAGS = 7  # as in `canonical.batches`
ROW = 8
CURVE = 5  # numbers of an arc

RAPID = 0
LINE = 1
ARC = 2
NOTE = 3  # a handler is called here; R_PLANE is its number, `ends` has its words

TAKEN = 0
LEFT = 2
JUMPED = 3

INCREMENTAL = 91
INCH = 20
MOST_IDLE = 100_000
LETTER_F = 5
LETTER_I = 8
LETTER_R = 17
BIT_R = 8
BIT_Q = 16
BIT_P = 32
BIT_L = 64
LETTER_L = 11
LETTER_P = 15
LETTER_Q = 16
LETTER_X = 23
LETTERS = 26
MOST_ROWS = 8192
MOST_STEPS = 32

NO_CYCLE = 80
OFF = 40  # compensation
FIRST_CYCLE = 73
PECK_BREAK = 73
PECK = 83
RETURN_R = 99
STROKE = 4  # numbers of a line of a cycle
MOST_STROKE = 4096  # lines executed at a hole
MOST_REPEATS = 9999.0
RETURNED = -1
CUT_SHORT = -2
CENTRE_BITS = 7
ARC_BITS = 15

A_END = A_SIZE  # the program point a block goes to
A_TARGET = A_SIZE + 8
A_WORDS = A_SIZE + 16  # of a block, while the text of its cycle is executed
A_RUN_SIZE = A_SIZE + 42
