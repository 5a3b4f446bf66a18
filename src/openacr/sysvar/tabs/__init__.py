"""The tabs of the system parameters and the cells of programs, one module per theme."""

from openacr.sysvar.tabs.cells import CELLS
from openacr.sysvar.tabs.control import COMMUNICATIONS, COMPATIBILITY, CONTROL, DISPLAY, GENERAL
from openacr.sysvar.tabs.motion import AXES_TAB, HOME, JOG, SERVO, SPEEDS
from openacr.sysvar.tabs.offsets import MESSAGES, OFFSETS
from openacr.sysvar.tabs.wiring import FOV, IO, PROBE, ROV, SOV, SPINDLE, TOOL

TAB_CELLS = 50_000

TABS = (
    GENERAL,
    SERVO,
    AXES_TAB,
    CONTROL,
    HOME,
    JOG,
    IO,
    FOV,
    ROV,
    SOV,
    PROBE,
    SPEEDS,
    COMPATIBILITY,
    COMMUNICATIONS,
    SPINDLE,
    DISPLAY,
    TOOL,
    OFFSETS,
    MESSAGES,
)

__all__ = ["CELLS", "TABS", "TAB_CELLS"]
