"""The dialogs of the wizard: every answer with its title, unit and limits, one row each.

Types, limits and defaults are those of `answers`; a row adds what a person reads.
"""

from dataclasses import dataclass
from typing import Any

from msgspec import NODEFAULT, Struct, inspect

from openacr.configure.answers import (
    AxisAnswers,
    CanOpen,
    CardAnswers,
    Drive,
    Gains,
    Limits,
    MasterAnswers,
)


@dataclass(frozen=True, slots=True)
class Row:
    """One answer: its key in the table, what it is called and measured in, and what it does."""

    key: str
    title: str
    unit: str = ""
    help: str = ""


@dataclass(frozen=True, slots=True)
class Dialog:
    """Answers that are asked together: a table, or one within a table of the file."""

    name: str
    title: str
    of: str  # "card", or "axis" or "master", of which there may be several
    table: type[Struct]
    rows: tuple[Row, ...]
    within: str = ""  # the key of the table within that one


def _word(key: str, title: str, unit: str = "") -> Row:
    """An answer that the word of AcroBASIC with the name of its key takes."""
    return Row(key, title, unit, key.upper())


DIALOGS = (
    Dialog("card", "Card", "card", CardAnswers, (
        Row("model", "Model", "", "Axes, masters and outputs are checked against it."),
        Row("option", "Option code", "", "For the comment at the head of the code."),
        Row("firmware", "Firmware", "",
            "From 1.18.15 on the card watches the limits; older ones get a program for it."),
        Row("minimal", "Minimal code", "",
            "Without the code that only analog inputs and CANopen nodes need."),
        Row("plcs", "PLCs of the user", "", "That get memory, from PLC0 on."),
        Row("moves", "Buffered moves", "", "Of a host, for which PROG0 gets memory."),
    )),
    Dialog("canopen", "CANopen", "card", CanOpen, (
        Row("master_id", "Node number of the card"),
        Row("bit_rate_kbps", "Bit rate", "kbit/s"),
        Row("cycle_ms", "Cycle", "ms"),
        Row("nodes", "Nodes"),
    ), within="canopen"),
    Dialog("axis", "Axis, feedback and scaling", "axis", AxisAnswers, (
        Row("number", "Number", "", "Of the axis on the card."),
        Row("name", "Name", "", "Programs call it so: one to four letters, not P or F."),
        Row("units_per_rev", "Travel in a turn", "units/rev",
            "User units in a revolution of the motor: the lead of a screw."),
        Row("counts_per_rev", "Encoder counts in a turn", "counts/rev", "Four per line."),
        Row("encoder", "Encoder", "", "That closes the loop; that of the same number if empty."),
        Row("dac", "Analog output", "",
            "That leads to the drive; that of the same number if empty."),
        Row("excess_error", "Excess position error", "units", "EXC."),
    )),
    Dialog("gains", "Servo loop", "axis", Gains, (
        _word("pgain", "Proportional gain", "V/count"),
        _word("igain", "Integral gain"),
        _word("ilimit", "Limit of the integral part", "V"),
        _word("idelay", "Delay of the integral part", "s"),
        _word("dgain", "Derivative gain"),
        _word("dwidth", "Sampling of the derivative", "s"),
        _word("ffvel", "Velocity feedforward"),
        _word("ffacc", "Acceleration feedforward"),
        _word("tlm", "Limit of the output", "V"),
        _word("fbvel", "Velocity feedback"),
    ), within="gains"),
    Dialog("drive", "Drive", "axis", Drive, (
        Row("uses_signals", "Enable, reset and fault lines", "", "They are connected."),
        Row("is_fault_inverted", "Fault opens the line"),
        Row("step_and_direction", "Step and direction", "", "The drive takes pulses."),
        Row("disable_on_excess_error", "Excess error kills and disables", "",
            "The axis is killed and its drive drops."),
        Row("disable_on_excess_error_only", "Excess error disables only", "",
            "The drive drops and nothing is killed."),
        Row("disable_on_kill", "Kill disables", "",
            "The drive drops at every Kill All Motion Request."),
    ), within="drive"),
    Dialog("limits", "Limits", "axis", Limits, (
        Row("first_input", "First input", "",
            "Of the positive switch; negative and home switch follow. Three times the number of the"
            " axis if empty."),
        Row("contacts_are_closed", "Contacts are closed", "", "The switches open at the ends."),
        Row("is_enabled", "Switches act"),
        Row("deceleration", "Deceleration at a switch", "units/s²", "HLDEC"),
        Row("soft", "Ends of travel by position", "units", "Positive, negative."),
        Row("soft_is_enabled", "Ends by position act", "", "As soon as they are given if empty."),
        Row("soft_deceleration", "Deceleration at them", "units/s²",
            "SLDEC; that of the switches if empty."),
    ), within="limits"),
    Dialog("master", "Master", "master", MasterAnswers, (
        Row("number", "Number", "", "The program it is attached to has the same."),
        Row("axes", "Axes", "", "Names of the axes that it moves together."),
        _word("acc", "Acceleration", "units/s²"),
        _word("dec", "Deceleration between moves", "units/s²"),
        _word("stp", "Deceleration to rest", "units/s²"),
        _word("vel", "Velocity", "units/s"),
        Row("jrk", "Jerk", "units/s³", "JRK; 0: no limit."),
    )),
)  # fmt: skip

_KINDS: dict[type, str] = {
    inspect.BoolType: "switch",
    inspect.IntType: "count",
    inspect.FloatType: "number",
    inspect.StrType: "text",
    inspect.EnumType: "choice",
    inspect.TupleType: "pair",
    inspect.VarTupleType: "names",
}


def data() -> list[dict[str, Any]]:
    """All dialogs as data for a screen: rows with kind, limits, choices and default."""
    return [
        {
            "name": dialog.name,
            "title": dialog.title,
            "of": dialog.of,
            "within": dialog.within,
            "rows": [_row(row, fields[row.key]) for row in dialog.rows],
        }
        for dialog in DIALOGS
        for fields in [{field.encode_name: field for field in _fields(dialog.table)}]
    ]


def _fields(table: type[Struct]) -> tuple[inspect.Field, ...]:
    info = inspect.type_info(table)
    if not isinstance(info, inspect.StructType):
        raise TypeError(f"{table} is not a table")
    return info.fields


def _row(row: Row, field: inspect.Field) -> dict[str, Any]:
    kind, is_optional = field.type, False
    if isinstance(kind, inspect.UnionType):
        kind, is_optional = kind.types[0], True
    found: dict[str, Any] = {
        "key": row.key,
        "title": row.title,
        "unit": row.unit,
        "help": row.help,
        "kind": _KINDS[type(kind)],
        "is_optional": is_optional,
        "default": None if field.default is NODEFAULT else field.default,
    }
    if isinstance(kind, inspect.EnumType):
        found["choices"] = [each.value for each in kind.cls]
    if isinstance(kind, inspect.IntType | inspect.FloatType):
        found["low"] = kind.ge if kind.ge is not None else kind.gt
        found["high"] = kind.le
    return found
