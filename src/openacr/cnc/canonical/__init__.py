"""Canonical moves: what a part program comes down to.

The interpreter yields these, in the order in which they have to happen; planner, preview,
run-time estimate, checks and card driver read nothing else. Positions are machine
positions in default units (degrees for rotary axes), feeds default units per minute,
angles radians, times seconds.

The list is pulled: entries before a `Sync` are done when the reader asks for the one after
it, not before. A reader without a machine (check, plot) continues at once.
"""

from openacr.cnc.canonical.actions import (
    Ask,
    BlockEnd,
    Check,
    Confirm,
    Coolant,
    Dwell,
    End,
    Orient,
    Output,
    Pause,
    Say,
    SetBit,
    SetCell,
    Spin,
    Spindle,
    Stop,
    Sync,
    Tapping,
    Tool,
    Transfer,
    WaitBit,
)
from openacr.cnc.canonical.batches import Moves
from openacr.cnc.canonical.common import (
    AXES,
    AXIS_LETTERS,
    PLANES,
    ROTARY,
    TOOL_AXIS,
    Pace,
    PathMode,
    Plane,
    Point,
    Source,
)
from openacr.cnc.canonical.moves import Arc, Line, Polyline, Probe, Rapid

Motion = Rapid | Line | Arc | Polyline | Probe | Moves
Action = (
    Dwell
    | Spindle
    | Orient
    | Tapping
    | Coolant
    | Output
    | SetBit
    | WaitBit
    | Tool
    | Transfer
    | Confirm
    | Say
    | Ask
    | Stop
    | SetCell
)
Entry = Motion | Action | BlockEnd | Sync | End

__all__ = [
    "AXES",
    "AXIS_LETTERS",
    "PLANES",
    "ROTARY",
    "TOOL_AXIS",
    "Action",
    "Arc",
    "Ask",
    "BlockEnd",
    "Check",
    "Confirm",
    "Coolant",
    "Dwell",
    "End",
    "Entry",
    "Line",
    "Motion",
    "Moves",
    "Orient",
    "Output",
    "Pace",
    "PathMode",
    "Pause",
    "Plane",
    "Point",
    "Polyline",
    "Probe",
    "Rapid",
    "Say",
    "SetBit",
    "SetCell",
    "Source",
    "Spin",
    "Spindle",
    "Stop",
    "Sync",
    "Tapping",
    "Tool",
    "Transfer",
    "WaitBit",
]
