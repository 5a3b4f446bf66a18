"""Panels of status, declared row by row: what is worth seeing of axes, masters, programs ...

`openacr monitor`, `openacr status` and the screens show the same rows. Another panel is another
list here.
"""

from msgspec import Struct

from openacr.client.names import full_names
from openacr.errors import UserError
from openacr.map import Flag, Parameter


class Row(Struct, frozen=True):
    """A parameter or flag of every object of a panel; `{object}` in its name is the object's."""

    name: str
    column: str = ""  # of `openacr monitor`; empty: not among its columns


class Group(Struct, frozen=True):
    """Rows under a heading."""

    title: str
    rows: tuple[Row, ...]


class StatusPanel(Struct, frozen=True):
    """Objects side by side, and what is to be seen of each."""

    name: str
    title: str
    objects: tuple[str, ...]
    groups: tuple[Group, ...]

    @property
    def columns(self) -> tuple[Row, ...]:
        """The rows that are columns of `openacr monitor`."""
        return tuple(row for group in self.groups for row in group.rows if row.column)


def _rows(*names: str) -> tuple[Row, ...]:
    return tuple(map(Row, names))


def _numbered(thing: str, count: int) -> tuple[str, ...]:
    return tuple(f"{thing}{number}" for number in range(count))


PANELS = (
    StatusPanel("axes", "Axes", _numbered("AXIS", 16), (
        Group("Setpoint part by part", (
            Row("Current Position", "position"),
            *_rows("Gear Offset", "Jog Offset", "Cam Offset", "Primary Setpoint"),
            *_rows("Ballscrew Offset", "Backlash Offset", "Secondary Setpoint"),
        )),
        Group("Loop", (
            Row("Actual Position", "actual"),
            Row("Following Error", "following_error"),
            *_rows("Summation Point", "Output Signal", "Velocity", "PPU"),
        )),
        Group("State", (
            Row("Drive Enabled", "enabled"),
            Row("Kill All Motion Request", "killed"),
            Row("Jog Active", "jogging"),
            *_rows("Not In Position", "Not Excess Error", "Drive Fault", "Drive Fault Input"),
            Row("Open Servo Loop"),
            *_rows("Gear Active", "Home Successful"),
        )),
        Group("Limits", _rows(
            "Positive Limit Input", "Negative Limit Input",
            "Positive Hardware Limit Enable", "Negative Hardware Limit Enable",
            "Positive Hardware Limit Encountered", "Negative Hardware Limit Encountered",
            "Positive Software Limit Encountered", "Negative Software Limit Encountered",
        )),
    )),
    StatusPanel("masters", "Masters", _numbered("MASTER", 16), (
        Group("Motion", _rows(
            "Vector Velocity", "Vector Acceleration", "Target Velocity", "Distance Into Move",
            "Distance To Go", "Move Counter", "MBUF Filled",
        )),
        Group("Overrides", _rows("Feedrate Override", "Rapid Feedrate Override")),
        Group("State", _rows(
            "In Motion", "Move Buffered", "Accelerating", "Decelerating", "Stopping",
            "Feedhold Request", "Feedholding", "In Feedhold", "Kill All Moves Request",
            "Stop All Moves Request", "Start Move Inhibit",
        )),
    )),
    StatusPanel("programs", "Programs", _numbered("PROG", 16), (
        Group("Place", _rows("Line Number")),
        Group("State", _rows(
            "Program Running", "Program Dwelling", "Program Inhibited", "Move Pending",
            "Pause Mode", "Block Control", "Block Mode Waiting", "Trace Mode Enable",
        )),
    )),
    StatusPanel("plcs", "PLCs", _numbered("PLC", 8), (
        Group("Scan", _rows("Tick Preload", "Tick Count")),
        Group("State", _rows("PLC Running", "First Scan", "Run Request", "Halt Request")),
    )),
    StatusPanel("encoders", "Encoders", _numbered("ENC", 16), (
        Group("Counts", _rows("Encoder Position", "Encoder Velocity", "ABS Revolution")),
        Group("State", _rows(
            "Encoder Signal Fault", "Encoder Signal Lost", "ABS DATA Ready", "ABS DATA Fault",
        )),
    )),
    StatusPanel("streams", "Streams", ("COM1", "COM2", "FIFO", "DPCB"), (
        Group("Buffers", _rows(
            "{object} Character Buffer Count", "{object} Line Buffer Count",
            "{object} Free Character Space", "{object} Command Counter",
        )),
        Group("State", _rows(
            "{object} Stream Active", "{object} Stream Opened", "{object} Stream Waiting",
            "{object} Stream Disabled", "{object} Stream Echoing",
        )),
    )),
    StatusPanel("card", "Card", ("MISCCTL1",), (
        Group("Motion enable", _rows("Motion Enable Input Open", "Motion Enable Input Latched")),
    )),
    StatusPanel("drives", "Drives (Drive Talk)", _numbered("DTALK", 16), (
        Group("Drive", _rows("Communication Device", "Drive Type", "DMODE", "DRIVE", "TADDR")),
        Group("Motion", _rows("TPC", "TPE", "TENC", "TVEL", "TVELC", "TVE", "TTRQ", "TCI")),
        Group("Health", _rows("TDTEMP", "TMTEMP", "TDBUS", "TANI", "TDHRS", "TDMIN", "TDSEC")),
    )),
    StatusPanel("network", "CANopen network", ("CAN",), (
        Group("Network", _rows(
            "Bus State", "Master Node ID", "Bit Rate", "Number Of Slave Nodes", "Cyclic Period",
            "Health Period",
        )),
        Group("State", _rows(
            "CANopen Controller Installed", "Network Operational", "Network Start Failed",
            "Node Failure", "SW Rx Overflow", "HW Rx Overflow",
        )),
    )),
    StatusPanel("nodes", "CANopen nodes", _numbered("CANNODE", 4), (
        Group("Node", _rows("Node ID", "Node State", "Health Type")),
        Group("Inputs and outputs", _rows(
            "Number Of Digital Inputs (Bytes)", "Number Of Digital Outputs (Bytes)",
            "Number Of Analog Inputs", "Number Of Analog Outputs",
        )),
    )),
)  # fmt: skip
AXES = PANELS[0]


def panel_named(name: str) -> StatusPanel:
    """The panel of this name; UserError if there is none."""
    for panel in PANELS:
        if panel.name == name:
            return panel
    raise UserError(f"no panel {name!r}: there are {', '.join(each.name for each in PANELS)}")


def record_of(row: Row, thing: str) -> Parameter | Flag | None:
    """What a row is of an object such as `AXIS0`; None where the object has nothing like it."""
    return full_names().get(f"{thing}.{row.name.format(object=thing)}".lower())


def flags_of(panel: StatusPanel, thing: str) -> dict[str, int]:
    """The numbers of the flags among the rows of a panel, by the names of the rows."""
    rows = [row for group in panel.groups for row in group.rows]
    found = {row.name: record_of(row, thing) for row in rows}
    return {name: each.number for name, each in found.items() if isinstance(each, Flag)}
