"""Drive Talk: status and configuration of Aries drives over a serial port."""

from openacr.map.block import FP32, LONG, NS, RW, UNDOCUMENTED, Access, Block, ManualRef, Span
from openacr.map.flag_block import FlagBlock

DRIVE_TALK = Block(
    "Drive Talk Parameters",
    object="DTALK",
    prefix="DTK",
    family="drive_talk",
    spans=(Span(28672, 16),),
    stride=256,
    ref=ManualRef.PROGRAMMERS_GUIDE,
)
DRIVE_TALK.row(0, "Communication Device", LONG, RW, "", "Device number the port was opened with.")
DRIVE_TALK.row(1, "Drive Type", LONG, RW, "", "Type of the drive, 0: Aries.")
DRIVE_TALK.row(21, "TPE", LONG, NS, "", "Torque or position error word of the drive.")

# The manual names no other number. The configuration follows the type, and the status
# items 8 to 25 are where item 9, TPE, puts them; which is which was decided here.
CONFIGURATION = (
    ("DMODE", "Mode of the drive: 2 torque, 4 velocity."),
    ("ERES", "Encoder counts per revolution."),
    ("SMPER", "Position error in counts from which on it is an error, 0 never."),
    ("DMTIP", "Peak current in A."),
    ("DMTSCL", "Current per volt of the command, of a torque drive."),
    ("DMVSCL", "Speed in rev/s per volt of the command, of a velocity drive."),
)
STATUS_ITEMS = (
    ("TPC", "Commanded position in counts."),
    ("TPE", ""),
    ("TENC", "Encoder counts since power-up."),
    ("TVEL", "Speed in rev/s."),
    ("TVELC", "Commanded speed in rev/s, of a velocity drive."),
    ("TVE", "Speed missing to the commanded one in rev/s, of a velocity drive."),
    ("TANI", "Voltage of the command in V."),
    ("TCI", "Commanded current in A, of a torque drive."),
    ("TTRQ", "Commanded torque in percent of the peak, of a torque drive."),
    ("TDIMAX", "Largest current of the drive in A."),
    ("TDTEMP", "Temperature of the drive in degrees Celsius."),
    ("TMTEMP", "Temperature of the motor in degrees Celsius."),
    ("TDBUS", "Voltage of the power bus in V."),
    ("TDHRS", "Hours since the drive was powered up."),
    ("TDMIN", "Minutes of the hour."),
    ("TDSEC", "Seconds of the minute."),
    ("TADDR", "Address of the drive."),
    ("DRIVE", "1 while the drive is enabled."),
)
FIRST_SETTING, FIRST_ITEM, FIRST_ITEM_FLAG = 2, 20, 8
_IN_COUNTS = {"TPC", "TENC"}
for _offset, (_name, _doc) in enumerate(CONFIGURATION, FIRST_SETTING):
    DRIVE_TALK.row(_offset, _name, FP32, RW, "", _doc)
for _offset, (_name, _doc) in enumerate(STATUS_ITEMS, FIRST_ITEM):
    if _doc:
        DRIVE_TALK.row(_offset, _name, LONG if _name in _IN_COUNTS else FP32, NS, "", _doc)

ERROR_LOG = FlagBlock(
    "Drive Talk Error-Log Flags",
    object="DTALK",
    prefix="DTEF",
    spans=(Span(4376, 16),),
    word_name="Drive Talk Error-Log Flags Axis {n}",
    ref=ManualRef.PROGRAMMERS_GUIDE,
    rest=UNDOCUMENTED,
)


STATUS_1 = FlagBlock(
    "Drive Talk Drive-Status 1 Flags",
    object="DTALK",
    prefix="DTS1",
    spans=(Span(4392, 16),),
    word_name="Drive Talk Drive-Status 1 Flags Axis {n}",
    ref=ManualRef.PROGRAMMERS_GUIDE,
    rest=UNDOCUMENTED,
)


STATUS_2 = FlagBlock(
    "Drive Talk Drive-Status 2 Flags",
    object="DTALK",
    prefix="DTS2",
    spans=(Span(4408, 16),),
    word_name="Drive Talk Drive-Status 2 Flags Axis {n}",
    ref=ManualRef.PROGRAMMERS_GUIDE,
    rest=UNDOCUMENTED,
)


CONTROL = FlagBlock(
    "Drive Talk Drive-Control Flags",
    object="DTALK",
    prefix="DTCF",
    spans=(Span(4424, 16),),
    word_name="Drive Talk Drive-Control Flags Axis {n}",
    ref=ManualRef.PROGRAMMERS_GUIDE,
    rest=UNDOCUMENTED,
)
CONTROL.row(0, "Auto Address Request", RW, "Assigns drive addresses (axis + 1); self clearing.")
CONTROL.row(1, "Get Configuration Request", RW, "Uploads the drive configuration; self clearing.")
CONTROL.row(
    2, "Send Configuration Request", RW, "Downloads the drive configuration; self clearing."
)
CONTROL.row(
    3, "Send ERRORL Request", RW, "Sends the error-log selection to the drive; self clearing."
)
CONTROL.row(4, "Get Drive Data Request", RW, "Fetches the selected drive data; self clearing.")
for _bit in range(8, 26):
    if _bit != 9:
        CONTROL.row(_bit, f"Drive Data Select {_bit}", RW, "Selects one item, which is not named.")
CONTROL.row(9, "TPE Select", RW, "Includes TPE in Get Drive Data.")
CONTROL.row(28, "Drive Status 1 Select", RW, "Includes the status 1 flags in Get Drive Data.")
CONTROL.row(29, "Drive Status 2 Select", RW, "Includes the status 2 flags in Get Drive Data.")


def _stream(name: str, word: int, word_name: str, access: Access = NS) -> FlagBlock:
    block = FlagBlock(
        "Drive Talk Stream Flags",
        object=name,
        prefix="DTSF",
        spans=(Span(word, 1),),
        word_name=word_name,
        ident=f"DTALK_{name}",
        ref=ManualRef.PROGRAMMERS_GUIDE,
        first_index=None,
        rest=UNDOCUMENTED,
    )
    block.inferred(
        0,
        "Auto Address All",
        access,
        "Addresses the drives of all axes on this stream; self clearing.",
    )
    block.row(18, "Stream Drive Lost", RW, "Cleared before Drive Talk is started.")
    block.row(19, "Stream Drive Timeout", RW, "Cleared before Drive Talk is started.")
    block.row(20, "Stream Address Error", RW, "Cleared before Drive Talk is started.")
    return block


BLOCKS = (DRIVE_TALK,)
FLAG_BLOCKS = (
    ERROR_LOG,
    STATUS_1,
    STATUS_2,
    CONTROL,
    _stream("LPT1", 4441, "Drive Talk LPT1 Stream Flags"),
    _stream("COM1", 4442, "Drive Talk COM1 Stream Flags"),
    _stream("COM2", 4443, "Drive Talk COM2 Stream Flags", RW),
    _stream("STREAM3", 4445, "Drive Talk DPCB/Stream 3 Stream Flags"),
    _stream("STREAM4", 4446, "Drive Talk Stream 4 Stream Flags"),
    _stream("STREAM5", 4447, "Drive Talk Stream 5 Stream Flags"),
)
