"""The tabs of the system parameters and the cells of programs, one module per theme.

A tab is a class whose attributes are its rows, declared where they are described: the number
of a cell (`SPEEDS.cut_speed`), or the range of the cells of a row that has several
(`AXIS.pulses_per_unit[axis]`).
"""

from openacr.sysvar.tabs.cells import CELLS
from openacr.sysvar.tabs.control import COMMUNICATIONS, COMPATIBILITY, CONTROL, DISPLAY, GENERAL
from openacr.sysvar.tabs.motion import AXIS, HOME, JOG, SERVO, SPEEDS
from openacr.sysvar.tabs.offsets import MESSAGES, OFFSETS
from openacr.sysvar.tabs.wiring import FOV, IO, PROBE, ROV, SOV, SPINDLE, TOOL, OverrideTab

TAB_CELLS = 50_000

TABS = tuple(
    each.tab
    for each in (
        GENERAL,
        SERVO,
        AXIS,
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
)

__all__ = [
    "AXIS",
    "CELLS",
    "COMMUNICATIONS",
    "COMPATIBILITY",
    "CONTROL",
    "DISPLAY",
    "FOV",
    "GENERAL",
    "HOME",
    "IO",
    "JOG",
    "MESSAGES",
    "OFFSETS",
    "PROBE",
    "ROV",
    "SERVO",
    "SOV",
    "SPEEDS",
    "SPINDLE",
    "TABS",
    "TAB_CELLS",
    "TOOL",
    "OverrideTab",
]
