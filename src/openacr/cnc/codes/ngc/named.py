"""Named parameters that are there in every program of the rs274ngc dialect: they show its state.

Names and meanings are those of LinuxCNC ("Predefined Named Parameters"). They cannot be assigned.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from msgspec import Struct

from openacr.cnc.canonical import AXIS_LETTERS, ROTARY, Spin
from openacr.cnc.codes.gcodes.work import SYSTEMS
from openacr.cnc.state.modal import INCH, INVERSE_TIME, METRIC, PER_MINUTE

if TYPE_CHECKING:
    from openacr.cnc.codes.run import Run

CODES = {work: code for code, work in SYSTEMS.items()}
PREDEFINED: dict[str, Named] = {}


class Named(Struct, frozen=True):
    """A name, as written in capitals, and how its value is found."""

    name: str
    read: Callable[[Run], float]
    meaning: str

    @property
    def shown(self) -> str:
        """As written in programs."""
        return f"#<{self.name.lower()}>"


def _add(name: str, read: Callable[[Run], float], meaning: str) -> None:
    PREDEFINED[name] = Named(name, read, meaning)


def _flag(name: str, test: Callable[[Run], bool], meaning: str) -> None:
    _add(name, lambda run: float(test(run)), f"1 {meaning}, else 0")


def _place(letter: str, point: str) -> Callable[[Run], float]:
    """The coordinate of a letter in a point of the path, in active units; 0 without the axis."""

    def read(run: Run) -> float:
        axis = run.planner.axes.get(letter)
        if axis is None:
            return 0.0
        value: float = getattr(run.path, point)[axis]
        return value if letter in ROTARY else run.path.shown(value)

    return read


def _line(run: Run) -> float:
    node = run.execution.node
    return float(node.line) if node else 0.0


for _letter in AXIS_LETTERS:
    _add(f"_{_letter}", _place(_letter, "program"), f"{_letter} of the program, active units")
for _letter in AXIS_LETTERS:
    _add(f"_ABS_{_letter}", _place(_letter, "target"), f"{_letter} of the machine, active units")
_add("_FEED", lambda run: run.path.shown(run.modal.feed), "F, active units per minute")
_add("_RPM", lambda run: run.modal.speed, "S, turns per minute")
_add("_CURRENT_TOOL", lambda run: float(run.modal.tool_in_spindle), "the tool in the spindle")
_add("_SELECTED_TOOL", lambda run: float(run.modal.tool), "the tool of the last T")
_add("_MOTION_MODE", lambda run: round(10 * run.motion_code), "10 times the G code of motion")
_add("_PLANE", lambda run: 10.0 * run.modal.plane, "170, 180 or 190")
_add("_CCOMP", lambda run: 10.0 * run.modal.compensation, "400, 410 or 420")
_add("_COORD_SYSTEM", lambda run: round(10 * CODES[run.modal.work]), "540 to 593")
_flag("_METRIC", lambda run: run.modal.unit == METRIC, "with G21")
_flag("_IMPERIAL", lambda run: run.modal.unit == INCH, "with G20")
_flag("_ABSOLUTE", lambda run: run.modal.distance == 90, "with G90")
_flag("_INCREMENTAL", lambda run: run.modal.distance == 91, "with G91")
_flag("_IJK_ABSOLUTE_MODE", lambda run: run.modal.centres == 2, "with G90.1")
_flag("_INVERSE_TIME", lambda run: run.modal.feed_mode == INVERSE_TIME, "with G93")
_flag("_UNITS_PER_MINUTE", lambda run: run.modal.feed_mode == PER_MINUTE, "with G94")
_add("_UNITS_PER_REV", lambda run: 0.0, "0: there is no G95")
_flag("_TOOL_OFFSET", lambda run: run.has_length, "with a tool length (G43)")
_flag("_RETRACT_R_PLANE", lambda run: run.modal.return_level == 99, "with G99")
_flag("_RETRACT_OLD_Z", lambda run: run.modal.return_level == 98, "with G98")
_add("_SPINDLE_RPM_MODE", lambda run: 1.0, "1: S is turns per minute (G97)")
_add("_SPINDLE_CSS_MODE", lambda run: 0.0, "0: there is no G96")
_flag("_SPINDLE_ON", lambda run: run.modal.spin is not Spin.OFF, "with M3 or M4")
_flag("_SPINDLE_CW", lambda run: run.modal.spin is Spin.CLOCKWISE, "with M3")
_flag("_MIST", lambda run: run.modal.mist, "with M7")
_flag("_FLOOD", lambda run: run.modal.flood, "with M8")
_flag("_FEED_OVERRIDE", lambda run: not run.modal.is_feed_locked, "with M48 or M50 P1")
_add("_SPEED_OVERRIDE", lambda run: 1.0, "1: the spindle override always acts")
_add("_FEED_HOLD", lambda run: 1.0, "1: feed hold always acts")
_add("_ADAPTIVE_FEED", lambda run: 0.0, "0: there is none")
_add("_LATHE_DIAMETER_MODE", lambda run: 0.0, "0: there is no G7")
_add("_LATHE_RADIUS_MODE", lambda run: 0.0, "0: there is no G8")
_add("_LINE", _line, "the line of this block")
_add("_CALL_LEVEL", lambda run: float(len(run.flow.frames)), "how many calls deep")
_add("_VALUE", lambda run: 0.0, "what the last subroutine returned")
_add("_VALUE_RETURNED", lambda run: 0.0, "1 where it returned something")
_add("_REMAP_LEVEL", lambda run: 0.0, "0: no code is remapped")
_add("_TASK", lambda run: 1.0, "1, also in check: it reads what a machine would execute")
