"""Inputs, outputs, user flags and the general control words."""

from openacr.map.block import FLAG_WORD_BASE, NS, RW, UNDOCUMENTED, R, Span, consecutive
from openacr.map.flag_block import FlagBlock, reserved_words

INPUTS = FlagBlock(
    "Optoisolated Inputs",
    object="INPUT",
    prefix="",
    spans=(Span(FLAG_WORD_BASE, 1),),
    word_name="Optoisolated Inputs",
    group="General Flags",
    ident="INPUTS",
    packet=consecutive(0x10),
    first_index=None,
)
for _bit in range(32):
    INPUTS.row(
        _bit,
        f"INP {_bit:02d}",
        R,
        f"Input on connector pin P4-{_bit + 1}.",
        erratum="Printed as pin P4-20, which is INP 19." if _bit == 29 else "",
    )

OUTPUTS = FlagBlock(
    "Optoisolated Outputs",
    object="OUTPUT",
    prefix="",
    spans=(Span(4097, 1),),
    word_name="Optoisolated Outputs",
    group="General Flags",
    ident="OUTPUTS",
    packet=consecutive(0x10),
    first_index=None,
    word_access=RW,
)
for _bit in range(32):
    OUTPUTS.row(
        _bit,
        f"OUT {_bit + 32}",
        RW,
        f"Output on connector pin P3-{_bit + 1}.",
        erratum="Printed as pin P3-20, which is OUT 51." if _bit == 29 else "",
    )

EXPANSION_INPUTS = FlagBlock(
    "Expansion I/O Flags",
    object="XIOIN",
    prefix="XIOI",
    spans=tuple(Span(4104 + 2 * board, 1) for board in range(4)),
    word_name="XIO Board {n} Inputs",
    packet=consecutive(0x10),
    word_doc="Can be mapped to CANopen inputs through P32771.",
)
EXPANSION_OUTPUTS = FlagBlock(
    "Expansion I/O Flags",
    object="XIOOUT",
    prefix="XIOO",
    spans=tuple(Span(4105 + 2 * board, 1) for board in range(4)),
    word_name="XIO Board {n} Outputs",
    packet=consecutive(0x10),
    word_doc="Can be mapped to CANopen outputs through P32771.",
)
for _bit in range(32):
    EXPANSION_INPUTS.row(_bit, f"INP {_bit:02d}", NS, f"Input {_bit} of an expansion board.")
    EXPANSION_OUTPUTS.row(_bit, f"OUT {_bit + 32}", NS, f"Output {_bit} of an expansion board.")

USER_FLAGS = FlagBlock(
    "User Flags",
    object="USER",
    prefix="UF",
    spans=(Span(4100, 4), Span(4156, 4)),
    word_name="User Group {n}",
    group=("General Flags", "Other Flags"),
    packet=consecutive(0x10),
    word_doc="Free for programs. Configuration wizards use BIT1952 to BIT2047.",
)
for _bit in range(32):
    USER_FLAGS.row(
        _bit, "User Defined", RW, "Free for programs; cleared at power-up.", ident=f"USER_{_bit}"
    )

MISC_INPUTS = FlagBlock(
    "Miscellaneous Inputs",
    object="MISCIN",
    prefix="MI",
    spans=(Span(4098, 1),),
    word_name="Miscellaneous Inputs",
    packet=consecutive(0x10),
    first_index=None,
    group="General Flags",
    ident="MISC_INPUTS",
)
for _bit in range(8):
    MISC_INPUTS.row(_bit, f"DIP Switch Input {_bit} (SW1-{8 - _bit})", NS, "Address switch.")
MISC_INPUTS.row(
    16, "20 ms Clock Pulse", NS, "Square wave, half of the period on.", ident="CLOCK_20_MS"
)
MISC_INPUTS.row(
    17, "100 ms Clock Pulse", NS, "Square wave, half of the period on.", ident="CLOCK_100_MS"
)
MISC_INPUTS.row(
    18, "1 Sec Clock Pulse", NS, "Square wave, half of the period on.", ident="CLOCK_1_S"
)
MISC_INPUTS.row(
    19, "1 Minute Clock Pulse", NS, "Square wave, half of the period on.", ident="CLOCK_1_MIN"
)

MISC_OUTPUTS = FlagBlock(
    "Miscellaneous Outputs",
    object="MISCOUT",
    prefix="MO",
    spans=(Span(4099, 1),),
    word_name="Miscellaneous Outputs",
    packet=consecutive(0x10),
    first_index=None,
    group="General Flags",
    ident="MISC_OUTPUTS",
)
for _bit in range(8):
    MISC_OUTPUTS.row(_bit, f"LED Bank Output {_bit} (D{34 + _bit})", NS, "Light on the board.")
MISC_OUTPUTS.row(8, "Sample Trigger Armed", NS, "Sampling waits for its trigger.")
MISC_OUTPUTS.row(9, "Sample In Progress", NS, "Samples are being taken.")
MISC_OUTPUTS.row(
    10, "Sample Mode Select", NS, "Clear: one sample per trigger; set: a run after one trigger."
)
MISC_OUTPUTS.row(11, "Sample Trigger Latched", NS, "The trigger has been seen.")
MISC_OUTPUTS.row(16, "Trigger AT Bus Interrupt", NS, "Interrupts the host; self clearing.")
MISC_OUTPUTS.row(
    17, "Trigger Software Capture", NS, "Captures the positions of all axes; self clearing."
)
for _board in range(4):
    MISC_OUTPUTS.row(20 + _board, f"Expansion I/O Enable {_board}", NS, "Set: the board is used.")
for _pls in range(8):
    MISC_OUTPUTS.row(24 + _pls, f"PLS{_pls} On", NS, "Set: the limit switch is evaluated.")

MISC_CONTROL_1 = FlagBlock(
    "Misc Control Group 1 Flags",
    object="MISCCTL",
    prefix="MC1",
    spans=(Span(4272, 1),),
    word_name="Misc Control Group {n}",
    packet=consecutive(0x10),
    first_index=1,
    group="Misc Control Flags",
    ident="MISC_CONTROL_1",
)
MISC_CONTROL_1.row(
    0, "Enable Fast Flags Update Mode", RW, "Refresh fast limit flags, one group each tick."
)
MISC_CONTROL_1.row(1, "STD Baud Rate")
MISC_CONTROL_1.row(2, "FBT")
MISC_CONTROL_1.row(
    13, "Motion Enable Input Latched", NS, "The input has opened; BIT5647 clears it."
)
MISC_CONTROL_1.row(
    14, "Motion Enable Input Open", NS, "Motion Enable Input is open (24 V missing)."
)
MISC_CONTROL_1.row(15, "Motion Enable Latch Reset Request", RW, "Clears the latch; self clearing.")
MISC_CONTROL_1.row(19, "Force Line Numbers With List", RW, "LIST shows line numbers while set.")
MISC_CONTROL_1.row(24, "Bootflash Invalid/empty", R, "Found by FIRMWARE CHECKSUM.")
MISC_CONTROL_1.row(25, "Sysflash1 Invalid/empty", R, "Found by FIRMWARE CHECKSUM.")
MISC_CONTROL_1.row(26, "Sysflash2 Invalid/empty", R, "Found by FIRMWARE CHECKSUM.")
MISC_CONTROL_1.row(27, "Userflash Invalid/empty", R, "Found by FIRMWARE CHECKSUM.")
MISC_CONTROL_1.row(28, "Firmware Backed Up", R, "System flash 1 and 2 agree; by FIRMWARE CHECKSUM.")

MISC_CONTROL_2_TO_4 = FlagBlock(
    "Misc Control Groups 2-4 Flags",
    object="MISCCTL",
    prefix="MC",
    spans=(Span(4273, 3),),
    word_name="Misc Control Group {n}",
    group="Misc Control Flags",
    packet=consecutive(0x10),
    first_index=2,
    rest=UNDOCUMENTED,
    word_erratum="Printed as Reserved in the parameter list, but not in the overview.",
)

FIREWIRE = FlagBlock(
    "Firewire Flags",
    object="FIREWIRE",
    prefix="",
    spans=(Span(4276, 1),),
    word_name="Firewire Flags",
    group="Misc Control Flags",
    ident="FIREWIRE",
    packet=consecutive(0x10),
    first_index=None,
    rest=UNDOCUMENTED,
    word_erratum="Printed as Reserved in the parameter list, but not in the overview.",
)

SPARE = reserved_words("Misc Control Flags", Span(4279, 1))

FLAG_BLOCKS = (
    INPUTS,
    OUTPUTS,
    MISC_INPUTS,
    MISC_OUTPUTS,
    EXPANSION_INPUTS,
    EXPANSION_OUTPUTS,
    USER_FLAGS,
    MISC_CONTROL_1,
    MISC_CONTROL_2_TO_4,
    FIREWIRE,
    SPARE,
)
