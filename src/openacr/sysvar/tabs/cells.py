"""The cells of programs in the store, P100 to P4095.

Cells 0 to 99 are variables of the card and have no row here. Lengths are in default units;
P101..P108 and the cells of canned cycles are in the active unit and therefore plain numbers.
"""

from openacr.sysvar.schema import AXES, At, Tab

_BY_AXIS = {"count": AXES, "is_by_axis": True}
HOME_PRESET = 300_001
RADIUS_OFFSETS, LENGTH_OFFSETS = 400, 999

CELLS = Tab("CELLS", 0)
CELLS.real(100, "Global 100", "", doc="Free for programs.")
CELLS.real(101, "G31 trip", "", doc="Machine position, active unit.", **_BY_AXIS)
CELLS.real(109, "Global {}", "", count=91, first=109, doc="Free for programs.")
CELLS.real(200, "User variable {}", "", count=34, first=200, doc="Sizes of library parts.")

CELLS.integer(234, "Tool selected", doc="By T, for the next M6.")
CELLS.integer(235, "Tool in spindle", doc="Since the last M6.")
CELLS.integer(236, "D number", doc="Of the radius in use.")
CELLS.integer(237, "H number", doc="Of the length in use.")
CELLS.real(238, "S", "rpm", doc="Spindle speed commanded.")
CELLS.real(239, "F", "", doc="Feed, active units/min.")
CELLS.integer(240, "Spindle state", 5, doc="3 clockwise, 4 counter-clockwise, 5 off.")
CELLS.integer(241, "Coolant state", doc="1 mist + 2 flood.")
CELLS.integer(242, "Unit", 20, doc="20 inch, 21 mm.")
CELLS.integer(243, "Executing line", doc="Of the program that runs.")
CELLS.choice(
    244,
    "Run state",
    {0: "idle", 1: "run", 2: "paused", 3: "wait", 4: "stop", 5: "alarm"},
    doc="What the runner does.",
)
CELLS.real(245, "Parts finished", "", doc="Passes of Repeat Forever.")
CELLS.integer(246, "Last alarm", doc="Code of the alarm.")
CELLS.real(247, "FOV percent", "%", doc="Feed override in use.")
CELLS.real(248, "Run time", "s", doc="Of this run, card time.")

CELLS.integer(249, "Cycle code", doc="73..89, 0 none.")
for _k, _name in enumerate(
    (
        "Cycle hole, first axis",
        "Cycle hole, second axis",
        "Cycle bottom",
        "Cycle R level",
        "Cycle initial level",
        "Cycle return level",
        "Cycle Q",
        "Cycle P seconds",
        "Cycle F",
        "Cycle L left",
        "Cycle G73 retract",
        "Cycle G83 clearance",
        "Cycle shift, first axis",
        "Cycle shift, second axis",
        "Cycle spindle at call",
        "Cycle return code",
        "Cycle plane",
        "Cycle distance mode",
        "Cycle last bottom",
        "Cycle next bottom",
        "Cycle direction",
    )
):
    CELLS.real(250 + _k, _name, "", doc="Set by canned cycles, active unit.")

CELLS.integer(271, "Homed axes", low=0, high=255, doc="Mask of axes that were homed.")
CELLS.real(272, "Reserved {}", "", count=8, first=272, doc="Reserved.")


def _home_preset(at: At) -> float:
    return at.read(HOME_PRESET + 1000 * at.axis)


CELLS.real(280, "Reference point 1", "u", _home_preset, doc="Of G27, G28.", **_BY_AXIS)
for _k in (2, 3, 4):
    CELLS.real(270 + 10 * _k, f"Reference point {_k}", "u", doc="Of G30.", **_BY_AXIS)
for _k in (288, 298, 308, 318):
    CELLS.real(_k, "Reserved {}", "", count=2, first=_k, doc="Reserved.")
CELLS.real(320, "Intermediate point", "u", doc="Memory of G28 and G30.", **_BY_AXIS)
CELLS.integer(328, "Intermediate mask", low=0, high=255, doc="Axes with a memory.")
CELLS.boolean(329, "G31 tripped", doc="Whether the last G31 tripped.")
CELLS.real(330, "G31 program position", "u", doc="Of the last trip.", **_BY_AXIS)
CELLS.real(338, "Reserved {}", "", count=62, first=338, doc="Reserved.")

CELLS.real(400, "Free {}", "", count=400, first=400, doc="Free for programs, kept.")
CELLS.boolean(800, "Floating zero active", doc="Whether any shift is active.")
CELLS.real(801, "Floating zero shift", "u", doc="By G92, SET ZERO.", **_BY_AXIS)
CELLS.real(809, "Floating zero word", "u", doc="Of the last G92.", **_BY_AXIS)
CELLS.real(817, "Floating zero before", "u", doc="For taking it back.", **_BY_AXIS)
CELLS.real(825, "Floating zero position", "u", doc="Machine position then.", **_BY_AXIS)
CELLS.real(833, "Free {}", "", count=67, first=833, doc="Free for programs, kept.")

CELLS.real(900, "Common work shift", "u", doc="Of all work systems.", **_BY_AXIS)
for _k in range(1, 9):
    _code = f"G{53 + _k}" if _k < 7 else f"G59.{_k - 6}"
    CELLS.real(900 + 10 * _k, f"Work system {_k}", "u", doc=f"Offset of {_code}.", **_BY_AXIS)
CELLS.real(990, "Local shift", "u", doc="By G52.", **_BY_AXIS)
CELLS.integer(998, "Work system in use", 1, low=0, high=8, doc="0 = G53.")
for _k in range(908, 999, 10):
    if _k != 998:
        CELLS.real(_k, "Free {}", "", count=2, first=_k, doc="Free.")
CELLS.real(999, "Free 999", "", doc="Free.")


def _offsets(base: int, name: str, count: int, doc: str) -> None:
    """Offset 0 is always 0, the others are tools."""
    CELLS.real(base, f"{name} 0", "u", is_fixed=True, doc="Always 0.")
    CELLS.real(base + 1, f"{name} {{}}", "u", count=count, first=1, doc=doc)


_offsets(1000, "D radius", RADIUS_OFFSETS, "Cutter radius.")
CELLS.real(1401, "Free {}", "", count=99, first=1401, doc="Free for programs, kept.")
_offsets(1500, "D wear", RADIUS_OFFSETS, "Wear of the radius.")
CELLS.real(1901, "Free {}", "", count=97, first=1901, doc="Free for programs, kept.")
CELLS.real(1998, "Current D radius", "u", doc="Set by D.")
CELLS.real(1999, "Current D wear", "u", doc="Set by D.")
_offsets(2000, "H length", LENGTH_OFFSETS, "Tool length.")
_offsets(3000, "H wear", LENGTH_OFFSETS, "Wear of the length.")
CELLS.real(4000, "Current H length", "u", doc="Set by H.")
CELLS.real(4001, "Current H wear", "u", doc="Set by H.")
CELLS.real(4002, "Free {}", "", count=94, first=4002, doc="Free for programs, kept.")
