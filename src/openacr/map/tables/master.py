"""Master parameters: P(8192 + 256 * master + row)."""

from openacr.map.block import FP32, LONG, RW, Block, R, Span, objects_apart

MASTER = Block(
    "Master Parameters",
    object="MASTER",
    prefix="MA",
    spans=(Span(8192, 16),),
    stride=256,
    packet=objects_apart,
)

MASTER.section("Master Parameters: Position")
MASTER.row(0x00, "Distance Into Move", FP32, R, "Distance already covered in the current move.")
MASTER.row(
    0x01,
    "Vector Velocity",
    FP32,
    R,
    "Combined vector speed of the attached axes; never negative, 0 up to the programmed VEL.",
)
MASTER.row(0x02, "Vector Acceleration", FP32, R, "Present vector acceleration, signed.")
MASTER.row(0x03, "Vector Jerk", FP32, R, "Present vector jerk.")
MASTER.row(0x04, "Vector Length", FP32, R, "Target position entered by the user.")
MASTER.row(
    0x05, "Target Velocity", FP32, R, "Programmed velocity of the move block being executed."
)
MASTER.row(
    0x06,
    "Target Acceleration",
    FP32,
    R,
    "Programmed acceleration of the move block being executed.",
)
MASTER.reserved(FP32, (0x07,))
MASTER.row(0x08, "Distance To Go", FP32, R, "Distance still to travel in the current move.")
MASTER.row(0x09, "Feedrate Override", FP32, R, "Feedrate override factor (FOV command).")
MASTER.row(0x0A, "Manual Vector", FP32, R, "Manual vector value (VECTOR command).")
MASTER.row(
    0x0B, "Total Distance", FP32, R, "Programmed path distance accumulated up to the current move."
)
MASTER.row(
    0x0C,
    "Distance Squared",
    FP32,
    R,
    "Squared vector distance of the buffered move over all attached axes.",
)
MASTER.row(0x0D, "Velocity Squared", FP32, R, "Squared present vector velocity.")
MASTER.row(0x0E, "Fraction Into Move", FP32, R, "Progress of the move, 0 at start to 1 at end.")
MASTER.row(0x0F, "Distance Into Path", FP32, R, "Distance travelled so far by the master.")

MASTER.section("Master Parameters: Sequence")
MASTER.row(
    0x10,
    "Move Counter",
    LONG,
    R,
    "Counts moves up or down when the master increment/decrement count flag is set.",
)
MASTER.reserved(LONG, (0x11, 0x12))
MASTER.row(
    0x13,
    "INT Response Period",
    LONG,
    RW,
    "Response period for HSINT and INT, in servo periods; default 5, -1 switches it off.",
)
MASTER.row(0x14, "MBUF Filled", LONG, R, "Number of moves waiting in multi-buffer (MBUF) mode.")
MASTER.reserved(LONG, range(0x15, 0x18))

MASTER.section("Master Parameters: Speed")
MASTER.row(
    0x18, "Rapid Feedrate Override", FP32, RW, "Rapid feedrate override factor (ROV command)."
)
MASTER.row(0x19, "Move Time", FP32, R, "Seconds allotted to each move (TMOV command).")
MASTER.row(
    0x1A,
    "Delta TMOV Time",
    FP32,
    R,
    "Shortest move time this master needs when masters run synchronised.",
)
MASTER.row(0x1B, "TMOV Velocity", FP32, R)
MASTER.row(0x1C, "Time Over Velocity", FP32, R, "Time override value (TOV command).")
MASTER.row(0x1D, "TOV Internal", FP32, R, "Time override value in effect right now.")
MASTER.row(
    0x1E, "TOV Rate", FP32, RW, "Rate at which the time override moves from one value to the next."
)
MASTER.row(0x1F, "User Velocity", FP32)

MASTER.section("Master Parameters: NURB Spline")
MASTER.row(
    0x20,
    "NURB Time Factor",
    FP32,
    RW,
    "Scales NURB time-mode speed; set before the move starts; halving it doubles the speed.",
)
MASTER.row(
    0x21,
    "NURB Start Time",
    FP32,
    RW,
    "Ramp from rest to full NURB speed; 0 means full speed at once.",
)
MASTER.reserved(FP32, (0x22, 0x23))
MASTER.row(
    0x24,
    "Spline Time Factor",
    FP32,
    RW,
    "Scales spline time-mode speed; set before the move starts; halving it doubles the speed.",
)
MASTER.row(
    0x25,
    "Spline Buffer Length",
    FP32,
    RW,
    "Spline buffer depth 2..5, default 5; a shorter buffer gives a less smooth curve.",
)
MASTER.reserved(FP32, (0x26, 0x27))

MASTER.section("Master Parameters: LookAhead")
MASTER.row(0x28, "VEL Limit", FP32, R, "Ceiling on the master vector velocity.")
MASTER.row(0x29, "Look Ahead Min Vel", FP32, RW, "Lowest speed look-ahead may slow down to.")
MASTER.row(
    0x2A, "Look Ahead Vector Angle", FP32, R, "3-D turn angle at the end of the current move."
)
MASTER.reserved(FP32, (0x2B,))
MASTER.row(
    0x2C,
    "TANG Turn Limit",
    FP32,
    RW,
    "Angle in degrees below which no extra tangential-axis move is inserted; default 0.",
)
MASTER.reserved(FP32, range(0x2D, 0x30))

MASTER.section("Master Parameters: Reserved")
MASTER.reserved(FP32, range(0x30, 0x38))
MASTER.reserved(LONG, range(0x38, 0x40))

BLOCKS = (MASTER,)
