"""GENERAL, CONTROL, COMPATIBILITY, COMMUNICATIONS and DISPLAY: how the front end behaves."""

from openacr.models import ACR8020
from openacr.sysvar.schema import OUTPUT, Tab

_CODES = {"doc": "Code chosen for the start of programs."}
_IJ = {0: "negative", 1: "positive", 2: "absolute"}

GENERAL = Tab("GENERAL", 100_000)
GENERAL.integer(0, "Store layout version", 1, is_fixed=True, doc="Of this table.")
GENERAL.motion()
GENERAL.integer(1, "Axis count", 3, low=2, high=8, doc="Axes of the machine.")
GENERAL.text(2, "Card model", ACR8020.name, doc="Model of the card.")
GENERAL.integer(3, "Card number", low=0, high=7, doc="Of several cards in one computer.")
GENERAL.still()
GENERAL.text(4, "Password hash", doc="Empty: no password is asked.")
GENERAL.motion()
GENERAL.integer(5, "Master, program", low=0, high=7, doc="Where the machine lives on the card.")
GENERAL.still()
GENERAL.text(6, "Error log name", "MILL.LOG", doc="File of the error log.")
GENERAL.boolean(10, "Start set chosen", doc="True: P100011 and up hold at the start.")
GENERAL.choice(
    11, "Start motion", {code: f"G{code}" for code in range(4)}, 1, doc="Code chosen for starts."
)
GENERAL.choice(12, "Start plane", {17: "G17", 18: "G18", 19: "G19"}, 17, **_CODES)
GENERAL.choice(
    13, "Start distance", {0: "as CONTROL", 90: "G90", 91: "G91"}, doc="0: as at power-up."
)
GENERAL.choice(14, "Start unit", {0: "as DISPLAY", 20: "G20", 21: "G21"}, doc="0: P850030.")
GENERAL.choice(15, "Start work system", {code: f"G{code}" for code in range(53, 60)}, 54, **_CODES)
GENERAL.choice(16, "Start path mode", {code: f"G{code}" for code in range(61, 65)}, 64, **_CODES)
GENERAL.choice(17, "Start return level", {98: "G98", 99: "G99"}, 98, **_CODES)
GENERAL.choice(18, "Start I/J", {-1: "as CONTROL", **_IJ}, -1, doc="-1: P250003.")
GENERAL.real(20, "CMP RAD", "u", doc="Cutter radius of programs without D.")
GENERAL.real(21, "RUN SETUP FEEDRATE", "u/m", low=0, high=1e6, doc="0 = Cut Speed.")

CONTROL = Tab("CONTROL", 250_000)
CONTROL.motion()
CONTROL.choice(
    1,
    "Default Units",
    {0: "inch", 1: "mm"},
    typical="inch",
    doc="Unit of all stored lengths and of Pulses/Unit; they are converted when it changes.",
)
CONTROL.still()
CONTROL.boolean(2, "Default Graphics", 1, typical="true", doc="Draw a part when it is loaded.")
CONTROL.choice(3, "I/J Inversion", _IJ, 2, typical="absolute", doc="Reading of I, J, K (G200).")
CONTROL.choice(4, "Lib Part I/J Inversion", _IJ, 2, typical="absolute", doc="In library parts.")
CONTROL.real(
    5, "Default Lead in Radius", "u", 0.25, typical="0.25", low=0, doc="Of parts and off-path."
)
CONTROL.boolean(6, "Goto Start After Start", typical="false", doc="Return after a dry run.")
for _k, _axis in enumerate("XYZ"):
    CONTROL.real(
        7 + _k, f"{_axis} Axis Cutting Size", "u", 24, typical="24", low=0, doc="Of the blank."
    )
CONTROL.real(
    10, "Acute Angle1 threshold", "deg", typical="0", low=0, high=180, doc="Corners slow down."
)
CONTROL.real(11, "Acute Angle2", "deg", typical="0", low=0, high=180, doc="Corners stop.")
CONTROL.real(12, "Under Burn Distance", "u", typical="0", low=0, doc="Height sensing off before.")
CONTROL.boolean(13, "Repeat Forever", typical="false", doc="Run the part in an endless loop.")
CONTROL.integer(14, "Under Burn Output", -1, doc="Its output.", **OUTPUT)
CONTROL.real(
    101,
    "Epsilon for Compensation",
    "u",
    0.002,
    typical="0.002",
    low=0,
    is_low_open=True,
    doc="Ends closer than this are joined.",
)
CONTROL.real(
    102, "Sweep Epsilon", "rad", 0.01, typical="0.01", low=0, high=1, doc="Smaller arcs are lines."
)
CONTROL.integer(
    103, "Root Epsilon", -4, typical="-4", low=-12, high=0, doc="Exponent: gap of two circles."
)
CONTROL.choice(
    111,
    "Power Up Incremental or Absolute",
    {90: "absolute", 91: "incremental"},
    90,
    typical="absolute",
    doc="G90 or G91 at power-up.",
)
CONTROL.integer(
    112, "Tangential Axis", -1, low=-1, high=7, words={-1: "disable"}, doc="Axis of M595..M599."
)
CONTROL.real(
    113, "Perpen/Tangent Epsilon", "deg", low=0, high=180, doc="Smaller turns insert no move."
)
CONTROL.integer(114, "Path Color", 10, typical="10", low=0, high=15, doc="Of the tool path.")
CONTROL.choice(115, "Position Display", {0: "big", 1: "small"}, typical="big", doc="Font.")
CONTROL.integer(
    116, "DripFeed Threshold", 40, typical="40", low=1, high=10_000, doc="Blocks before motion."
)
CONTROL.integer(
    117, "Forward Threshold", 10, typical="10", low=1, high=1_000, doc="Blocks kept ahead."
)
CONTROL.boolean(118, "Disable Error File", 1, typical="true", doc="True: no error log.")
CONTROL.text(119, "Machine Type", "MILL", typical="MILL", doc="Type of the machine.")
CONTROL.real(120, "DXF Safe Height", "u", 0.1, doc="Of moves between chains.")
CONTROL.real(121, "DXF drill Z", "u", -0.5, doc="Depth of imported holes.")
CONTROL.real(122, "DXF drill R", "u", 0.1, doc="Level above imported holes.")
CONTROL.real(123, "DXF drill F", "u/m", 10, low=0, is_low_open=True, doc="Feed of holes.")
CONTROL.integer(124, "I/O Expansion Modules", low=0, high=4, doc="Modules on the card.")
CONTROL.integer(
    125, "Watchdog Program", 7, low=-1, high=7, doc="On the card, for a lost host; -1: none."
)
CONTROL.real(126, "Link Timeout", "s", 2, low=1.5, high=60, doc="Longest time without the host.")
CONTROL.boolean(130, "Gouge Stop", 1, doc="True: a gouge refuses the program.")
CONTROL.boolean(
    131, "Spirals Allowed", doc="True: arcs whose two radii differ by any amount are meant."
)
CONTROL.real(140, "G73 Retract", "u", 0.02, low=0, doc="Of each peck of G73.")
CONTROL.real(141, "G83 Clearance", "u", 0.05, low=0, doc="Above the last bottom of G83.")
CONTROL.choice(
    142,
    "Fine Bore Shift Direction",
    {0: "+1st", 1: "-1st", 2: "+2nd", 3: "-2nd"},
    doc="Axis of the plane along which G76 and G87 shift.",
)
CONTROL.motion()
CONTROL.boolean(1000, "Input {} inverted", count=1000, doc="Active when it is off.")
CONTROL.boolean(2000, "Output {} inverted", count=1000, doc="Switched off to act.")

COMPATIBILITY = Tab("COMPATIBILITY", 700_000)
COMPATIBILITY.boolean(0, "Compatibility", typical="false", doc="True: G64 acts as G62.")
COMPATIBILITY.boolean(1, "Hash Input Test", 1, doc="IF #n = 0|1 tests input n.")
COMPATIBILITY.boolean(2, "M30 Ends Program", doc="M30 is M2, not output 6 off.")
COMPATIBILITY.boolean(3, "Block Skip Live", doc="Blocks with / wait for the motion.")
COMPATIBILITY.boolean(4, "M Codes On The Fly", doc="M7..M37 act without a stop.")
COMPATIBILITY.choice(
    5,
    "Dialect",
    {-1: "auto", 0: "acromill", 1: "rs274ngc"},
    -1,
    doc="Of part programs; auto: by the signs in the file.",
)
COMPATIBILITY.boolean(6, "Auto Include Cycles", doc="CYCLES.TXT needs no $I.")

COMMUNICATIONS = Tab("COMMUNICATIONS", 750_000)
COMMUNICATIONS.text(0, "Port", doc="Serial port of drip feed and LINK.")
COMMUNICATIONS.integer(1, "Baud", 9600, low=300, high=4_000_000, doc="Bits per second.")
COMMUNICATIONS.choice(2, "Data bits", {7: "7", 8: "8"}, 8, doc="Of a character.")
COMMUNICATIONS.choice(3, "Parity", {0: "none", 1: "even", 2: "odd"}, doc="Of a character.")
COMMUNICATIONS.choice(4, "Stop bits", {1: "1", 2: "2"}, 1, doc="Of a character.")
COMMUNICATIONS.choice(
    5, "Handshake", {0: "none", 1: "XON/XOFF", 2: "RTS/CTS"}, 1, doc="Flow control."
)

DISPLAY = Tab("DISPLAY", 850_000, per_axis=True)
_FORMAT = {"low": 0.1, "high": 9.9, "doc": "Digits left and right of the point."}
DISPLAY.real(0, "Inch format", "", 3.4, typical="3.4", **_FORMAT)
DISPLAY.real(1, "Metric format", "", 4.5, typical="4.5", **_FORMAT)
_ONE = {"is_per_axis": False}
DISPLAY.boolean(20, "Color via D Codes", doc="The path has the colour of its tool.", **_ONE)
DISPLAY.boolean(21, "Flip X Axis", doc="Mirror the drawing left and right.", **_ONE)
DISPLAY.boolean(22, "Flip Y Axis", doc="Mirror the drawing up and down.", **_ONE)
DISPLAY.boolean(23, "Exchange XY", doc="Swap the directions of the drawing.", **_ONE)
DISPLAY.choice(
    30, "Control Mode", {20: "inch", 21: "mm"}, 20, doc="Active unit at power-up.", **_ONE
)
