"""Every text the card itself prints when it refuses something, one row each.

Texts without a documented source were decided by this project; hosts only rely on
`Unknown command`. No text contains `>`: hosts take that character for a prompt.
"""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Message:
    """One message; `{}` stands for the detail (a name or a line number)."""

    number: int
    text: str


_all: list[Message] = []


def _row(text: str) -> Message:
    message = Message(len(_all), text)
    _all.append(message)
    return message


OK = _row("")
SYNTAX_ERROR = _row("Syntax error")
UNKNOWN_COMMAND = _row("Unknown command")
UNDEFINED_SYMBOL = _row("Undefined symbol")
UNDEFINED_VARIABLE = _row("Undefined variable")
INVALID_PARAMETER = _row("Invalid parameter")
INVALID_BIT = _row("Invalid bit")
SUBSCRIPT_OUT_OF_RANGE = _row("Subscript out of range")
TYPE_MISMATCH = _row("Type mismatch")
DIVIDE_BY_ZERO = _row("Divide by zero")
MATH_ERROR = _row("Math error")
INVALID_ARGUMENT = _row("Invalid argument")
OUT_OF_MEMORY = _row("Out of memory")
OUT_OF_DEFINE_SPACE = _row("Out of define space")
REDIMENSIONED_BLOCK = _row("Re-dimensioned block")
NOT_VALID_AT_THIS_LEVEL = _row("Not valid at this level")
PROGRAM_IS_RUNNING = _row("Program is running")
PROGRAMS_RUNNING = _row("Programs running")
PROGRAM_IN_MEMORY = _row("Program in memory")
LABEL_NOT_FOUND = _row("Label not found: {}")
LINE_NOT_FOUND = _row("Line not found: {}")
DUPLICATE_LABEL = _row("Duplicate label: {}")
IF_WITHOUT_ENDIF = _row("IF without ENDIF")
ELSE_WITHOUT_IF = _row("ELSE without IF")
ENDIF_WITHOUT_IF = _row("ENDIF without IF")
FOR_WITHOUT_NEXT = _row("FOR without NEXT")
NEXT_WITHOUT_FOR = _row("NEXT without FOR")
WHILE_WITHOUT_WEND = _row("WHILE without WEND")
WEND_WITHOUT_WHILE = _row("WEND without WHILE")
RETURN_WITHOUT_GOSUB = _row("RETURN without GOSUB")
BREAK_WITHOUT_LOOP = _row("BREAK without loop")
STACK_OVERFLOW = _row("Stack overflow")
NO_MASTER_ATTACHED = _row("No master attached")
MASTER_ALREADY_ATTACHED = _row("Master already attached")
SLAVE_ALREADY_ATTACHED = _row("Slave already attached")
AXIS_ALREADY_ATTACHED = _row("Axis already attached")
AXIS_IS_OFF = _row("Axis is off")
AXIS_IS_LOCKED = _row("Axis is locked")
NOT_VALID_WHILE_IN_MOTION = _row("Not valid while in motion")
SLAVE_KILL_ACTIVE = _row("Associated Slave Kill Motion Request Active")
MASTER_KILL_ACTIVE = _row("Master Kill All Moves Request Active")
SOFT_LIMIT = _row("Soft limit")
HARD_LIMIT = _row("Hard limit")
INVALID_ARC = _row("Invalid arc")
INVALID_SOURCE = _row("Invalid source")
NO_CAM_SEGMENTS = _row("No cam segments")
DEVICE_NOT_OPEN = _row("Device not open")
DEVICE_IN_USE = _row("Device in use")
INVALID_DEVICE = _row("Invalid device")
ILLEGAL_NAME = _row("Illegal name")
LINE_TOO_LONG = _row("Line too long")
PROGRAM_IS_PROTECTED = _row("Program is protected")
INVALID_PASSWORD = _row("Invalid password")
NOT_SUPPORTED = _row("Not supported")
PLC_TOO_LONG = _row("PLC too long")
PLC_ERROR = _row("PLC error line {}")
SAVE_FAILED = _row("Save failed")

MESSAGES: tuple[Message, ...] = tuple(_all)
