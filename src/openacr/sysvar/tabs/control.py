"""GENERAL, CONTROL, COMPATIBILITY, COMMUNICATIONS and DISPLAY: how the front end behaves."""

from openacr.models import ACR8020
from openacr.sysvar.schema import COLOUR, OUTPUT, Tab

_CODES = {"doc": "Code active at the start of programs."}
_IJ = {0: "negative", 1: "positive", 2: "absolute"}


class GENERAL:
    """The machine, its card, and the codes chosen for the start of programs."""

    tab = Tab("GENERAL", 100_000)
    store_layout_version = tab.integer(
        0, "Store layout version", 1, is_fixed=True, doc="Version of this table."
    )
    tab.motion()
    axis_count = tab.integer(1, "Axis count", 3, low=2, high=8, doc="Axes of the machine.")
    card_model = tab.text(2, "Card model", ACR8020.name, doc="Model of the card.")
    card_number = tab.integer(
        3, "Card number", low=0, high=7, doc="Number of the card, if the computer has several."
    )
    tab.still()
    password_hash = tab.text(4, "Password hash", doc="Empty: no password is set.")
    tab.motion()
    master_program = tab.integer(
        5,
        "Master, program",
        low=0,
        high=7,
        doc="Master and program of the card that the machine uses.",
    )
    tab.still()
    error_log_name = tab.text(6, "Error log name", "MILL.LOG", doc="File of the error log.")
    start_set_chosen = tab.boolean(
        10, "Start set chosen", doc="True: programs start with P100011 to P100018."
    )
    start_motion = tab.choice(
        11,
        "Start motion",
        {code: f"G{code}" for code in range(4)},
        1,
        doc="Code active at the start of programs.",
    )
    start_plane = tab.choice(12, "Start plane", {17: "G17", 18: "G18", 19: "G19"}, 17, **_CODES)
    start_distance = tab.choice(
        13, "Start distance", {0: "as CONTROL", 90: "G90", 91: "G91"}, doc="0: as at power-up."
    )
    start_unit = tab.choice(
        14, "Start unit", {0: "as DISPLAY", 20: "G20", 21: "G21"}, doc="0: P850030."
    )
    start_work_system = tab.choice(
        15, "Start work system", {code: f"G{code}" for code in range(53, 60)}, 54, **_CODES
    )
    start_path_mode = tab.choice(
        16, "Start path mode", {code: f"G{code}" for code in range(61, 65)}, 64, **_CODES
    )
    start_return_level = tab.choice(17, "Start return level", {98: "G98", 99: "G99"}, 98, **_CODES)
    start_ij = tab.choice(18, "Start I/J", {-1: "as CONTROL", **_IJ}, -1, doc="-1: P250003.")
    cmp_rad = tab.real(20, "CMP RAD", "u", doc="Cutter radius for programs without D.")
    run_setup_feedrate = tab.real(
        21,
        "RUN SETUP FEEDRATE",
        "u/m",
        low=0,
        high=1e6,
        doc="Feed before the first F, 0 = Cut Speed.",
    )


class CONTROL:
    """How programs are read and the machine behaves."""

    tab = Tab("CONTROL", 250_000)
    tab.motion()
    default_units = tab.choice(
        1,
        "Default Units",
        {0: "inch", 1: "mm"},
        typical="inch",
        doc="Unit of all stored lengths and of Pulses/Unit; a change converts them.",
    )
    tab.still()
    default_graphics = tab.boolean(
        2, "Default Graphics", 1, typical="true", doc="True: draw a part when it is loaded."
    )
    ij_inversion = tab.choice(
        3, "I/J Inversion", _IJ, 2, typical="absolute", doc="Meaning of I, J, K (G200)."
    )
    lib_part_ij_inversion = tab.choice(
        4,
        "Lib Part I/J Inversion",
        _IJ,
        2,
        typical="absolute",
        doc="Meaning of I, J, K in library parts.",
    )
    default_lead_in_radius = tab.real(
        5,
        "Default Lead in Radius",
        "u",
        0.25,
        typical="0.25",
        low=0,
        doc="Radius of leads of parts and back to the path.",
    )
    goto_start_after_start = tab.boolean(
        6,
        "Goto Start After Start",
        typical="false",
        doc="True: return to the start after a dry run.",
    )
    x_axis_cutting_size = tab.real(
        7,
        "X Axis Cutting Size",
        "u",
        24,
        typical="24",
        low=0,
        doc="Size of the blank along X, drawn in GRAPHICS.",
    )
    y_axis_cutting_size = tab.real(
        8,
        "Y Axis Cutting Size",
        "u",
        24,
        typical="24",
        low=0,
        doc="Size of the blank along Y, drawn in GRAPHICS.",
    )
    z_axis_cutting_size = tab.real(
        9,
        "Z Axis Cutting Size",
        "u",
        24,
        typical="24",
        low=0,
        doc="Size of the blank along Z, drawn in GRAPHICS.",
    )
    acute_angle1_threshold = tab.real(
        10,
        "Acute Angle1 threshold",
        "deg",
        typical="0",
        low=0,
        high=180,
        doc="Angle from which corners slow down.",
    )
    acute_angle2 = tab.real(
        11,
        "Acute Angle2",
        "deg",
        typical="0",
        low=0,
        high=180,
        doc="Angle from which corners stop.",
    )
    under_burn_distance = tab.real(
        12,
        "Under Burn Distance",
        "u",
        typical="0",
        low=0,
        doc="Height sensing goes off this far before the end of a cut.",
    )
    repeat_forever = tab.boolean(
        13, "Repeat Forever", typical="false", doc="True: repeat the part until stopped."
    )
    under_burn_output = tab.integer(
        14, "Under Burn Output", -1, doc="Output that switches height sensing.", **OUTPUT
    )
    epsilon_for_compensation = tab.real(
        101,
        "Epsilon for Compensation",
        "u",
        0.002,
        typical="0.002",
        low=0,
        is_low_open=True,
        doc="Ends closer than this are joined.",
    )
    sweep_epsilon = tab.real(
        102,
        "Sweep Epsilon",
        "rad",
        0.01,
        typical="0.01",
        low=0,
        high=1,
        doc="Arcs of a smaller sweep are cut as lines.",
    )
    root_epsilon = tab.integer(
        103,
        "Root Epsilon",
        -4,
        typical="-4",
        low=-12,
        high=0,
        doc="Exponent of 10: tolerance for circles that nearly meet.",
    )
    power_up_incremental_or_absolute = tab.choice(
        111,
        "Power Up Incremental or Absolute",
        {90: "absolute", 91: "incremental"},
        90,
        typical="absolute",
        doc="G90 or G91 at power-up.",
    )
    tangential_axis = tab.integer(
        112,
        "Tangential Axis",
        -1,
        low=-1,
        high=7,
        words={-1: "disable"},
        doc="Axis turned by M595..M599.",
    )
    perpen_tangent_epsilon = tab.real(
        113,
        "Perpen/Tangent Epsilon",
        "deg",
        low=0,
        high=180,
        doc="Turns up to this angle insert no move.",
    )
    path_color = tab.integer(
        114, "Path Color", 10, typical="10", doc="Colour of the tool path.", **COLOUR
    )
    position_display = tab.choice(
        115,
        "Position Display",
        {0: "big", 1: "small"},
        typical="big",
        doc="Font of the position display.",
    )
    dripfeed_threshold = tab.integer(
        116,
        "DripFeed Threshold",
        40,
        typical="40",
        low=1,
        high=10_000,
        doc="Blocks received before motion starts.",
    )
    forward_threshold = tab.integer(
        117, "Forward Threshold", 10, typical="10", low=1, high=1_000, doc="Blocks read ahead."
    )
    disable_error_file = tab.boolean(
        118, "Disable Error File", 1, typical="true", doc="True: no error log."
    )
    machine_type = tab.text(119, "Machine Type", "MILL", typical="MILL", doc="Type of the machine.")
    dxf_safe_height = tab.real(120, "DXF Safe Height", "u", 0.1, doc="Z of moves between chains.")
    dxf_drill_z = tab.real(121, "DXF drill Z", "u", -0.5, doc="Depth of imported holes.")
    dxf_drill_r = tab.real(122, "DXF drill R", "u", 0.1, doc="R level above imported holes.")
    dxf_drill_f = tab.real(
        123, "DXF drill F", "u/m", 10, low=0, is_low_open=True, doc="Feed of imported holes."
    )
    io_expansion_modules = tab.integer(
        124, "I/O Expansion Modules", low=0, high=4, doc="Modules on the card."
    )
    watchdog_program = tab.integer(
        125,
        "Watchdog Program",
        7,
        low=-1,
        high=7,
        doc="Program of the card that stops it when the host is lost, -1: none.",
    )
    link_timeout = tab.real(
        126, "Link Timeout", "s", 2, low=1.5, high=60, doc="Longest time without the host."
    )
    gouge_stop = tab.boolean(130, "Gouge Stop", 1, doc="True: a gouge is an error.")
    spirals_allowed = tab.boolean(131, "Spirals Allowed", doc="True: arcs may have any two radii.")
    g73_retract = tab.real(
        140, "G73 Retract", "u", 0.02, low=0, doc="Retract after each peck of G73."
    )
    g83_clearance = tab.real(
        141, "G83 Clearance", "u", 0.05, low=0, doc="Clearance above the last bottom of G83."
    )
    fine_bore_shift_direction = tab.choice(
        142,
        "Fine Bore Shift Direction",
        {0: "+1st", 1: "-1st", 2: "+2nd", 3: "-2nd"},
        doc="Axis of the plane along which G76 and G87 shift.",
    )
    tab.motion()
    input_inverted = tab.series(1000).boolean(
        1000, "Input {} inverted", doc="True: the input is active when off."
    )
    output_inverted = tab.series(1000).boolean(
        2000, "Output {} inverted", doc="True: the output is active when off."
    )


class COMPATIBILITY:
    """Where old programs want another reading."""

    tab = Tab("COMPATIBILITY", 700_000)
    compatibility = tab.boolean(0, "Compatibility", typical="false", doc="True: G64 acts as G62.")
    hash_input_test = tab.boolean(1, "Hash Input Test", 1, doc="IF #n = 0|1 tests input n.")
    m30_ends_program = tab.boolean(
        2, "M30 Ends Program", doc="True: M30 ends programs, as M2; false: output 6 off."
    )
    block_skip_live = tab.boolean(
        3, "Block Skip Live", doc="True: blocks with / wait for the end of the motion."
    )
    m_codes_on_the_fly = tab.boolean(
        4, "M Codes On The Fly", doc="True: M7..M37 act without stopping the motion."
    )
    dialect = tab.choice(
        5,
        "Dialect",
        {-1: "auto", 0: "acromill", 1: "rs274ngc"},
        -1,
        doc="Dialect of part programs; auto: recognised from the file.",
    )
    auto_include_cycles = tab.boolean(
        6, "Auto Include Cycles", doc="True: cycles work without $I CYCLES.TXT."
    )


class COMMUNICATIONS:
    """The serial port of drip feed and LINK."""

    tab = Tab("COMMUNICATIONS", 750_000)
    port = tab.text(0, "Port", doc="Serial port of drip feed and LINK.")
    baud = tab.integer(1, "Baud", 9600, low=300, high=4_000_000, doc="Bits per second.")
    data_bits = tab.choice(2, "Data bits", {7: "7", 8: "8"}, 8, doc="Data bits per character.")
    parity = tab.choice(
        3, "Parity", {0: "none", 1: "even", 2: "odd"}, doc="Parity of each character."
    )
    stop_bits = tab.choice(4, "Stop bits", {1: "1", 2: "2"}, 1, doc="Stop bits per character.")
    handshake = tab.choice(
        5, "Handshake", {0: "none", 1: "XON/XOFF", 2: "RTS/CTS"}, 1, doc="Flow control."
    )


_FORMAT = {"low": 0.1, "high": 9.9, "doc": "Digits before and after the point."}


VIEWS = ("position feeds estop", "position distance next", "modal feeds buttons")


class DISPLAY:
    """Read-outs and the drawing."""

    tab = Tab("DISPLAY", 850_000)
    inch_format = tab.per_axis.real(0, "Inch format", "", 3.4, typical="3.4", **_FORMAT)
    metric_format = tab.per_axis.real(1, "Metric format", "", 4.5, typical="4.5", **_FORMAT)
    color_via_d_codes = tab.boolean(
        20, "Color via D Codes", doc="True: the path has the colour of its tool."
    )
    flip_x_axis = tab.boolean(21, "Flip X Axis", doc="True: mirror the drawing left to right.")
    flip_y_axis = tab.boolean(22, "Flip Y Axis", doc="True: mirror the drawing top to bottom.")
    exchange_xy = tab.boolean(23, "Exchange XY", doc="True: swap X and Y in the drawing.")
    control_mode = tab.choice(
        30, "Control Mode", {20: "inch", 21: "mm"}, 20, doc="Active unit at power-up."
    )
    views = tab.series(3, first=1).text(
        40,
        "View {} blocks",
        lambda at: VIEWS[at.index - 1],
        doc="What the view of the main screen shows: words of position, distance, next, modal,"
        " estop, feeds, buttons.",
    )
