"""Which flags tell the story of each example."""

from tests.examples.observe import Watch

MOTION, KILL_MOVES, KILL = 516, 522, 8467

GANTRY = Watch("gantry", (10, 34, MOTION, 548, 1024, 1056, 8465, 8497, 8529), 3)
SQUARE = Watch("square", (MOTION, 517, 518, 519, 1024, 1050), 2)
DIAMONDS = Watch("diamonds", (MOTION, 792, 824, 1024), 3)
BASIC_MOTION = Watch("basic_motion", (MOTION, 792, 1024), 1)
_HOMING = (MOTION, 777, 792, 809, 824, 841, 856, 1024, KILL, 16134, 16135, 16166, 16167)
HOMING = Watch("homing_xyz", (*_HOMING, 16198, 16199), 3)
MISSING_SWITCH = Watch(
    "homing_xyz", (9, 10, *HOMING.flags), 3, "missing_switch.toml", "missing_switch.txt"
)
_STOPS = (KILL_MOVES, KILL, 8499, 8465, 8497, 8477, 8479, 8509, 8511, 16132, 16140)
ERRORS = Watch("error_handler", (16, MOTION, 792, 824, 1024, 1050, 1056, *_STOPS), 2)
_NOT_EXCESS = (769, 801, 833, 865, 897, 929, 961, 993)
EXCESS = Watch("plc_excess_error", (32, MOTION, *_NOT_EXCESS, 1536), 8)
_PANEL, _GATE = (256, 257, 288, 289), (320, 321, 352)
CANOPEN = Watch("canopen_io", (*_PANEL, *_GATE, MOTION, 11265, 11269, 11271, 1024), 1)
CIRCLES = Watch("circles", (MOTION, 1024), 2)
HELIX = Watch("helix", (MOTION, 1024), 3)
SPLINE = Watch("spline_curve", (128, 129, MOTION, 1024, 5129, 5131), 2)
AIRFOIL = Watch("nurb_airfoil", (MOTION, 1024, 5141, 5146, 5147), 2)
ARM = Watch("invk_arm", (MOTION, KILL_MOVES, 1024), 2)
GEARS = Watch("gear_box", (MOTION, 792, 814, 820, 821, 1024), 2)
LOCKED = Watch("gantry_lock", (MOTION, 1024), 2)
SHEAR = Watch("cam_flying_shear", (32, 792, 822, 1024), 2)
BRUSHLESS = Watch("brushless", (MOTION, 1024, 3584, 3585), 1)
TUNING = Watch("tuning", (MOTION, 512, 513, 514, 1024), 1)
LABELS = Watch("pick_and_label", (10, 11, 12, 13, 14, 32, 33, 34, MOTION, 1024), 1)

ALL = (
    GANTRY,
    SQUARE,
    DIAMONDS,
    BASIC_MOTION,
    HOMING,
    MISSING_SWITCH,
    ERRORS,
    EXCESS,
    CANOPEN,
    CIRCLES,
    HELIX,
    SPLINE,
    AIRFOIL,
    ARM,
    GEARS,
    LOCKED,
    SHEAR,
    BRUSHLESS,
    TUNING,
    LABELS,
)
