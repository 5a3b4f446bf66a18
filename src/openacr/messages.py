"""Every text the card itself prints when it refuses something, one row each.

Texts without a documented source were decided by this project; hosts only rely on
`Unknown command`. No text contains `>`: hosts take that character for a prompt.

A row keeps its number: programs that were ended by an error hold it, and so do snapshots. A new row
gets the next number. Sources of the core write `messages.MATH_ERROR.number`.
"""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Message:
    """One message; `{}` is replaced by the detail (a name or a line number)."""

    number: int
    text: str


MESSAGES: dict[int, Message] = {}


def _row(number: int, text: str) -> Message:
    if number in MESSAGES:
        raise ValueError(f"message {number} is there twice: {MESSAGES[number].text!r}, {text!r}")
    return MESSAGES.setdefault(number, Message(number, text))


OK = _row(0, "")
SYNTAX_ERROR = _row(1, "Syntax error")
UNKNOWN_COMMAND = _row(2, "Unknown command")
UNDEFINED_SYMBOL = _row(3, "Undefined symbol")
UNDEFINED_VARIABLE = _row(4, "Undefined variable")
INVALID_PARAMETER = _row(5, "Invalid parameter")
INVALID_BIT = _row(6, "Invalid bit")
SUBSCRIPT_OUT_OF_RANGE = _row(7, "Subscript out of range")
TYPE_MISMATCH = _row(8, "Type mismatch")
DIVIDE_BY_ZERO = _row(9, "Divide by zero")
MATH_ERROR = _row(10, "Math error")
INVALID_ARGUMENT = _row(11, "Invalid argument")
OUT_OF_MEMORY = _row(12, "Out of memory")
OUT_OF_DEFINE_SPACE = _row(13, "Out of define space")
REDIMENSIONED_BLOCK = _row(14, "Re-dimensioned block")
NOT_VALID_AT_THIS_LEVEL = _row(15, "Not valid at this level")
PROGRAM_IS_RUNNING = _row(16, "Program is running")
PROGRAMS_RUNNING = _row(17, "Programs running")
PROGRAM_IN_MEMORY = _row(18, "Program in memory")
LABEL_NOT_FOUND = _row(19, "Label not found: {}")
LINE_NOT_FOUND = _row(20, "Line not found: {}")
DUPLICATE_LABEL = _row(21, "Duplicate label: {}")
IF_WITHOUT_ENDIF = _row(22, "IF without ENDIF")
ELSE_WITHOUT_IF = _row(23, "ELSE without IF")
ENDIF_WITHOUT_IF = _row(24, "ENDIF without IF")
FOR_WITHOUT_NEXT = _row(25, "FOR without NEXT")
NEXT_WITHOUT_FOR = _row(26, "NEXT without FOR")
WHILE_WITHOUT_WEND = _row(27, "WHILE without WEND")
WEND_WITHOUT_WHILE = _row(28, "WEND without WHILE")
RETURN_WITHOUT_GOSUB = _row(29, "RETURN without GOSUB")
BREAK_WITHOUT_LOOP = _row(30, "BREAK without loop")
STACK_OVERFLOW = _row(31, "Stack overflow")
NO_MASTER_ATTACHED = _row(32, "No master attached")
MASTER_ALREADY_ATTACHED = _row(33, "Master already attached")
SLAVE_ALREADY_ATTACHED = _row(34, "Slave already attached")
AXIS_ALREADY_ATTACHED = _row(35, "Axis already attached")
AXIS_IS_OFF = _row(36, "Axis is off")
AXIS_IS_LOCKED = _row(37, "Axis is locked")
NOT_VALID_WHILE_IN_MOTION = _row(38, "Not valid while in motion")
SLAVE_KILL_ACTIVE = _row(39, "Associated Slave Kill Motion Request Active")
MASTER_KILL_ACTIVE = _row(40, "Master Kill All Moves Request Active")
SOFT_LIMIT = _row(41, "Soft limit")
HARD_LIMIT = _row(42, "Hard limit")
INVALID_ARC = _row(43, "Invalid arc")
INVALID_SOURCE = _row(44, "Invalid source")
NO_CAM_SEGMENTS = _row(45, "No cam segments")
DEVICE_NOT_OPEN = _row(46, "Device not open")
DEVICE_IN_USE = _row(47, "Device in use")
INVALID_DEVICE = _row(48, "Invalid device")
ILLEGAL_NAME = _row(49, "Illegal name")
LINE_TOO_LONG = _row(50, "Line too long")
PROGRAM_IS_PROTECTED = _row(51, "Program is protected")
INVALID_PASSWORD = _row(52, "Invalid password")
NOT_SUPPORTED = _row(53, "Not supported")
PLC_TOO_LONG = _row(54, "PLC too long")
PLC_ERROR = _row(55, "PLC error line {}")
SAVE_FAILED = _row(56, "Save failed")
