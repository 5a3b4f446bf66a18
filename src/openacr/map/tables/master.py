"""Master parameters: P(8192 + 256 * master + row)."""

from openacr.map.block import FP32, LONG, NS, RW, Block, R, Span, objects_apart

MASTER = Block(
    "Master Parameters",
    object="MASTER",
    prefix="MA",
    family="masters",
    spans=(Span(8192, 16),),
    stride=256,
    packet=objects_apart,
    packet_erratum="Chapter 6 prints group 0x21 for masters 8 to 15 in one place; it is 0x28.",
)

MASTER.section("Master Parameters: Position")
MASTER.row(0x00, "Distance Into Move", FP32, R, "unit", "Distance covered in the present move.")
MASTER.row(0x01, "Vector Velocity", FP32, R, "unit/s", "Present speed along the path.")
MASTER.row(0x02, "Vector Acceleration", FP32, R, "unit/s²", "Present path acceleration, signed.")
MASTER.row(0x03, "Vector Jerk", FP32, R, "unit/s³", "Present path jerk.")
MASTER.row(0x04, "Vector Length", FP32, R, "unit", "Length of the present move.")
MASTER.row(0x05, "Target Velocity", FP32, R, "unit/s", "Programmed speed of the present move.")
MASTER.row(0x06, "Target Acceleration", FP32, R, "unit/s²", "Programmed ramp of the present move.")
MASTER.reserved(FP32, (0x07,))
MASTER.row(0x08, "Distance To Go", FP32, R, "unit", "Distance left in the present move.")
MASTER.row(0x09, "Feedrate Override", FP32, R, "", "Factor on feed moves (FOV).", default=1)
MASTER.row(0x0A, "Manual Vector", FP32, R, "unit", "Length of a move without weights (VECTOR).")
MASTER.row(0x0B, "Total Distance", FP32, R, "unit", "Programmed distance up to the present move.")
MASTER.row(0x0C, "Distance Squared", FP32, R, "unit²", "Square of the buffered move's length.")
MASTER.row(0x0D, "Velocity Squared", FP32, R, "unit²/s²", "Square of the present path speed.")
MASTER.row(0x0E, "Fraction Into Move", FP32, R, "", "Progress of the present move, 0 to 1.")
MASTER.row(0x0F, "Distance Into Path", FP32, R, "unit", "Distance covered by the master so far.")

MASTER.section("Master Parameters: Sequence")
MASTER.row(
    0x10, "Move Counter", LONG, R, "", "Counts moves, with Increment or Decrement Count set."
)
MASTER.reserved(LONG, (0x11, 0x12))
MASTER.row(
    0x13, "INT Response Period", LONG, RW, "tick", "Pause of HSINT and INT, -1: never.", default=5
)
MASTER.row(0x14, "MBUF Filled", LONG, R, "", "Moves waiting in the multi-move buffer (MBUF).")
MASTER.reserved(LONG, range(0x15, 0x18))

MASTER.section("Master Parameters: Speed")
MASTER.row(0x18, "Rapid Feedrate Override", FP32, RW, "", "Factor on rapid moves (ROV).", default=1)
MASTER.row(0x19, "Move Time", FP32, R, "s", "Time every move takes (TMOV).")
MASTER.row(0x1A, "Delta TMOV Time", FP32, R, "s", "Shortest time of the next synchronised move.")
MASTER.row(0x1B, "TMOV Velocity", FP32, R, "unit/s", "Speed found for a timed move.")
MASTER.row(
    0x1C,
    "Time Over Velocity",
    FP32,
    R,
    "",
    "Factor on the time base, 0 to 2 (TOV).",
    default=1,
    erratum="Printed as P9245, which is TOV Internal of the same master; the stride gives P9244.",
    erratum_at=4,
)
MASTER.row(0x1D, "TOV Internal", FP32, R, "", "Time base factor in effect right now.", default=1)
MASTER.row(0x1E, "TOV Rate", FP32, RW, "1/s", "Change of the time base, 0: at once.", default=1)
MASTER.row(0x1F, "User Velocity", FP32, NS, "unit/s", "Programmed speed (VEL).", default=10000)

MASTER.section("Master Parameters: NURB Spline")
MASTER.row(0x20, "NURB Time Factor", FP32, RW, "s", "Time per knot unit in mode 0.", default=1)
MASTER.row(0x21, "NURB Start Time", FP32, RW, "s", "Ramp to full NURB speed, 0: none.")
MASTER.reserved(FP32, (0x22, 0x23))
MASTER.row(0x24, "Spline Time Factor", FP32, RW, "", "Factor on spline knots in mode 0.", default=1)
MASTER.row(0x25, "Spline Buffer Length", FP32, RW, "", "Points looked at, 2 to 5.", default=5)
MASTER.reserved(FP32, (0x26, 0x27))

MASTER.section("Master Parameters: LookAhead")
MASTER.row(0x28, "VEL Limit", FP32, R, "unit/s", "Highest path speed, 0: no limit.")
MASTER.row(0x29, "Look Ahead Min Vel", FP32, RW, "unit/s", "Lowest speed look-ahead slows down to.")
MASTER.row(0x2A, "Look Ahead Vector Angle", FP32, R, "deg", "Turn at the end of the present move.")
MASTER.reserved(FP32, (0x2B,))
MASTER.row(
    0x2C, "TANG Turn Limit", FP32, RW, "deg", "Turn from which the tangent axis turns alone."
)
MASTER.reserved(FP32, range(0x2D, 0x30))

MASTER.section("Master Parameters: Reserved")
MASTER.reserved(FP32, range(0x30, 0x38))
MASTER.reserved(LONG, range(0x38, 0x40))

BLOCKS = (MASTER,)
