"""The objects of a CiA 402 drive that the card uses: index, type, unit.

Positions are in counts of the drive, speeds in counts/s, torques in thousandths of the rated
torque, as the profile has them without a unit of the drive's own.
"""

from typing import NamedTuple


class Entry(NamedTuple):
    """An object of the dictionary of a drive."""

    object: int
    name: str
    type: str  # of the module struct, without the byte order
    unit: str = ""

    @property
    def bits(self) -> int:
        """Its size in process data."""
        return {"b": 8, "B": 8, "h": 16, "H": 16, "i": 32, "I": 32}[self.type]


ERROR_CODE = Entry(0x603F, "error code", "H")
CONTROL_WORD = Entry(0x6040, "control word", "H")
STATUS_WORD = Entry(0x6041, "status word", "H")
MODE = Entry(0x6060, "mode of operation", "b")
MODE_DISPLAY = Entry(0x6061, "mode of operation, as it is", "b")
ACTUAL_POSITION = Entry(0x6064, "actual position", "i", "counts")
TARGET_TORQUE = Entry(0x6071, "target torque", "h", "0.1 %")
MOST_TORQUE = Entry(0x6072, "largest torque", "H", "0.1 %")
TARGET_POSITION = Entry(0x607A, "target position", "i", "counts")
QUICK_STOP_OPTION = Entry(0x605A, "what a quick stop does", "h")
PROBE_FUNCTION = Entry(0x60B8, "touch probe function", "H")
PROBE_STATUS = Entry(0x60B9, "touch probe status", "H")
PROBE_1_RISE = Entry(0x60BA, "position at the rising edge of probe 1", "i", "counts")
PROBE_1_FALL = Entry(0x60BB, "position at the falling edge of probe 1", "i", "counts")
PROBE_2_RISE = Entry(0x60BC, "position at the rising edge of probe 2", "i", "counts")
PROBE_2_FALL = Entry(0x60BD, "position at the falling edge of probe 2", "i", "counts")
INTERPOLATION_TIME = Entry(0x60C2, "interpolation time", "B")  # 1: the time, 2: power of ten [s]
DIGITAL_INPUTS = Entry(0x60FD, "digital inputs", "I")
TARGET_VELOCITY = Entry(0x60FF, "target velocity", "i", "counts/s")
SUPPORTED_MODES = Entry(0x6502, "supported modes", "I")


class Mode(NamedTuple):
    """A cyclic mode: its number in 0x6060, its bit in 0x6502, its target."""

    number: int
    bit: int
    target: Entry


MODES = {
    "csp": Mode(8, 7, TARGET_POSITION),
    "csv": Mode(9, 8, TARGET_VELOCITY),
    "cst": Mode(10, 9, TARGET_TORQUE),
}
