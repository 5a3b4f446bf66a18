"""CANopen extended I/O and Ethernet Powerlink of the ACR9000 family."""

from openacr.map.block import FP32, LONG, NS, RW, UNDOCUMENTED, Access, Block, ManualRef, R, Span
from openacr.map.flag_block import FlagBlock

NETWORK = Block(
    "CANopen Network Parameters",
    object="CAN",
    prefix="CAN",
    family="canopen",
    spans=(Span(32768, 1),),
    stride=0,
    indexed=False,
    ref=ManualRef.PROGRAMMERS_GUIDE,
)
NETWORK.row(
    0, "Master Node ID", LONG, RW, "", "Node number of the controller, 1 to 127.", default=5
)
NETWORK.row(1, "Bit Rate", LONG, RW, "kbit/s", "Speed of the bus.", default=125)
NETWORK.row(
    2, "Number Of Slave Nodes", LONG, RW, "", "Nodes besides the controller, 0 to 4.", default=1
)
NETWORK.row(
    3, "Alternate Digital I/O Mapping", LONG, RW, "", "Nodes in P4104 to P4111: 1, 2, 3: all."
)
NETWORK.row(4, "Cyclic Period", LONG, RW, "ms", "Time from update to update.", default=50)
NETWORK.row(5, "Health Period", LONG, R, "ms", "Ten times the cyclic period.", default=500)
NETWORK.reserved(LONG, (6,))
NETWORK.row(7, "Number Of Digital Input Bytes", LONG, R, "byte", "Found on the whole network.")
NETWORK.row(8, "Number Of Digital Output Bytes", LONG, R, "byte", "Found on the whole network.")
NETWORK.row(9, "Number Of Analog Inputs", LONG, R, "", "Found on the whole network.")
NETWORK.row(10, "Number Of Analog Outputs", LONG, R, "", "Found on the whole network.")
NETWORK.row(
    11, "Bus State", LONG, R, "", "0 not set up, 1 ready to start, 2 started, 3 to 10 faults."
)
NETWORK.reserved(LONG, (14, 15))

NODE = Block(
    "CANopen Node Parameters",
    object="CANNODE",
    prefix="CANN",
    family="canopen_nodes",
    spans=(Span(33024, 4),),
    stride=16,
    ref=ManualRef.PROGRAMMERS_GUIDE,
)
NODE.row(
    0, "Node ID", LONG, RW, "", "Number of the node on the bus, 1 to 127.", default=(1, 0, 0, 0)
)
NODE.row(1, "Number Of Digital Inputs (Bytes)", LONG, R, "byte", "Found when the network starts.")
NODE.row(2, "Number Of Digital Outputs (Bytes)", LONG, R, "byte", "Found when the network starts.")
NODE.row(3, "Number Of Analog Inputs", LONG, R, "", "Found when the network starts.")
NODE.row(4, "Number Of Analog Outputs", LONG, R, "", "Found when the network starts.")
NODE.row(5, "Health Type", LONG, R, "", "0 absent, 1 heartbeat, 2 life guarding.")
NODE.row(6, "Node State", LONG, R, "", "0 dead, 1 live.")


def _analog_section(channel: int) -> str:
    return f"CANopen Node {channel // 32} Analog I/O Parameters"


# Channel n of the family is channel n % 32 of node n // 32.
DAC = Block(
    "CANopen Analog Outputs",
    object="CANDAC",
    prefix="CANDAC",
    family="canopen_dacs",
    spans=(Span(33280, 128),),
    stride=16,
    ref=ManualRef.PROGRAMMERS_GUIDE,
    section_of=_analog_section,
)
DAC.row(0, "DAC Output Value", FP32, RW, "V", "Value put out.")
DAC.reserved(FP32, (1,))
DAC.row(2, "DAC Gain", FP32, RW, "count/V", "Counts of the converter per volt.", default=3276.8)
DAC.row(3, "DAC Offset", FP32, RW, "V", "Added to every output.")
DAC.reserved(FP32, range(4, 8))

ADC = Block(
    "CANopen Analog Inputs",
    object="CANADC",
    prefix="CANADC",
    family="canopen_adcs",
    spans=(Span(33280, 128),),
    stride=16,
    ref=ManualRef.PROGRAMMERS_GUIDE,
    section_of=_analog_section,
)
ADC.row(8, "ADC Input Value", FP32, R, "V", "Value measured.")
ADC.reserved(FP32, (9,))
ADC.row(10, "ADC Gain", FP32, RW, "V", "Value at full scale of the converter.", default=10)
ADC.row(11, "ADC Offset", FP32, RW, "V", "Added to every input.")
ADC.reserved(FP32, range(12, 16))

CAN_FLAGS = FlagBlock(
    "CANopen Control/Status Flags",
    object="CAN",
    prefix="CANF",
    spans=(Span(4448, 1),),
    word_name="Extended I/O Control/Status",
    first_index=None,
    ident="CAN",
    ref=ManualRef.PROGRAMMERS_GUIDE,
    rest=UNDOCUMENTED,
)
CAN_FLAGS.row(1, "Start Network", RW, "Starts the CANopen network; clears when the attempt ends.")
CAN_FLAGS.row(2, "Reset Network", RW, "Resets all extended I/O nodes.")
CAN_FLAGS.row(4, "CANopen Controller Installed", R, "Set if the CANopen hardware is present.")
CAN_FLAGS.row(5, "Network Operational", R, "Set while the network is operational.")
CAN_FLAGS.row(6, "Network Start Failed", R, "Set when a start request failed.")
CAN_FLAGS.row(7, "Node Failure", R, "Set when a node is lost or silent while operational.")
CAN_FLAGS.row(8, "SW Rx Overflow", R, "Software receive buffer overflowed.")
CAN_FLAGS.row(9, "HW Rx Overflow", R, "Hardware receive buffer overflowed.")
CAN_FLAGS.reserved(3)

EPL_FLAGS = FlagBlock(
    "EPL Flags",
    object="EPL",
    prefix="EPLF",
    spans=(Span(4616, 1),),
    word_name="EPL Flags",
    first_index=None,
    ident="EPL",
    ref=ManualRef.PROGRAMMERS_GUIDE,
    rest=UNDOCUMENTED,
)
EPL_FLAGS.row(0, "EPL Start Pending", NS, "Polled until the network has started, in one example.")
EPL_FLAGS.row(8, "EPL Card Present", NS, "Set when the controller has recognised the EPL card.")
EPL_FLAGS.row(9, "EPL Network Operational", NS, "Set while the EPL network runs.")
EPL_FLAGS.row(10, "EPL Network Start Failed", NS, "Set when starting the EPL network failed.")
EPL_FLAGS.row(16, "EPL Start In Progress", NS, "Waited on to clear after EPLC ON.")
EPL_FLAGS.row(17, "EPL Reset In Progress", NS, "Waited on to clear after EPLC OFF.")


def _digital(object: str, first: int, direction: str, short: str, access: Access) -> FlagBlock:
    block = FlagBlock(
        "CANopen Digital I/O Flags",
        object=object,
        prefix=object,
        spans=tuple(Span(first + 32 * node, 16) for node in range(4)),
        word_name=f"Node {{n}} Digital {direction} {{first}}-{{last}}",
        ref=ManualRef.PROGRAMMERS_GUIDE,
        words_per_object=16,
        word_access=access,
    )
    for bit in range(32):
        block.row(bit, f"Node {{n}} {short} {{io}}", access)
    return block


BLOCKS = (NETWORK, NODE, DAC, ADC)
FLAG_BLOCKS = (
    CAN_FLAGS,
    EPL_FLAGS,
    _digital("CANDI", 4456, "Inputs", "DI", R),
    _digital("CANDO", 4472, "Outputs", "DO", RW),
)
