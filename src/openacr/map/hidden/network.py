"""Hidden rows of the networks: nodes and drives on them, and what the card knows of both.

`BUS` rows are part of the world outside, which a restart of the card leaves alone; `NET` rows
belong to the card. Ticks are float64 numbers; 0 stands for never.
"""

from openacr.map.hidden.block import ROWS_F, HiddenBlock

NODES = 4
WORDS_PER_NODE = 16
ANALOG_CHANNELS = 32
PORTS = 7
LINE_LENGTH = 80
ANSWER_LENGTH = 256
LOG_ENTRIES = 8

# The world: node n of the machine file.
NODE = HiddenBlock(
    prefix="BUSN",
    family="bus_nodes",
    count=NODES,
    doubles=(
        ("measured", ANALOG_CHANNELS),  # what is at the analog inputs, in their unit
        "input_low",  # range of the analog inputs and outputs
        "input_high",
        "output_low",
        "output_high",
    ),
    ints=(
        "id",  # 0: there is no such node
        "bit_rate",
        "coupler",
        "health",  # 1 heartbeat, 2 node guarding
        "digital_inputs",
        "digital_outputs",
        "analog_inputs",
        "analog_outputs",
        "analog_bits",
        "state",  # 0 without power, 1 pre-operational, 2 operational
        ("levels", WORDS_PER_NODE),  # at the digital inputs
        ("outputs", WORDS_PER_NODE),  # at the digital outputs
        ("converted", ANALOG_CHANNELS),  # counts at the analog outputs
    ),
    ranges={
        "id": (0, 127),
        "digital_inputs": (0, 32 * WORDS_PER_NODE),
        "digital_outputs": (0, 32 * WORDS_PER_NODE),
        "analog_inputs": (0, ANALOG_CHANNELS),
        "analog_outputs": (0, ANALOG_CHANNELS),
        "analog_bits": (0, 32),
    },
)

FAULT = HiddenBlock(
    prefix="BUSX",
    family="bus_faults",
    count=16,
    doubles=("from_s", "until_s", "rate"),
    ints=("kind", "node"),
    ranges={
        "node": (-1, NODES),
    },
)

# What comes to an analog input from somewhere in the world: source * scale + offset.
SIGNAL = HiddenBlock(
    prefix="BUSS",
    family="bus_signals",
    count=16,
    doubles=("scale", "offset"),
    ints=(
        "input",  # index (into F) of what is at the input, 0: no such signal
        "axis",  # the motor whose position it is, -1: an analog output
        "node",  # of the output
        "channel",
    ),
    ranges={
        "input": (0, ROWS_F),
        "axis": (-1, 15),
        "node": (0, NODES - 1),
        "channel": (0, ANALOG_CHANNELS - 1),
    },
)

BUS = HiddenBlock(
    prefix="BUS",
    family="bus",
    count=1,
    doubles=("before_s",),  # lived before the card was switched on the last time
    ints=("fitted",),  # the card has a CANopen controller
)

# The card: its network master, and each of its slave nodes.
MASTER = HiddenBlock(
    prefix="NETM",
    family="network_master",
    count=1,
    doubles=(
        "phase_tk",  # end of the present phase
        "sync_tk",
        "arrival_tk",  # the answers to the last sync are complete
        "health_tk",
        "errors",  # error counter of the controller
    ),
    ints=(
        "phase",
        "slave",  # that is being interrogated
        "slaves",
        "mapping",  # P32771 as it was at the start
        "bit_rate",
        "cycle_ms",
        "frames",  # of one cycle
    ),
    ranges={
        "slave": (0, NODES),
        "slaves": (0, NODES),
    },
)

SLAVE = HiddenBlock(
    prefix="NETS",
    family="network_slaves",
    count=NODES,
    doubles=("change_tk",),  # a message with changed inputs arrives
    ints=(
        "node",  # which node of the world it is
        "live",
        "words",  # of its digital inputs
        ("sent", WORDS_PER_NODE),  # inputs the node has sent last
        ("latched", ANALOG_CHANNELS),  # counts of its inputs at the last sync
    ),
    ranges={
        "node": (0, NODES - 1),
        "words": (0, WORDS_PER_NODE),
    },
)

# The world: the drive of motor n, as its serial port shows it.
DRIVE = HiddenBlock(
    prefix="BUSD",
    family="bus_drives",
    count=16,
    doubles=(
        ("settings", 6),  # see plant/bus/aries.py
        "connected_s",
        "powered_s",
        "lost_s",
        "back_s",
        "drive_temp_c",
        "motor_temp_c",
        "bus_v",
        ("log_s", LOG_ENTRIES),
    ),
    ints=(
        "kind",  # 0: no drive that can talk
        "port",
        "baud",
        "address",
        "revision",  # in hundredths
        "selection",  # errors it logs
        "errors",  # at the last look
        "log_count",
        ("log_error", LOG_ENTRIES),
    ),
    ranges={
        "port": (-1, PORTS),
        "log_count": (0, LOG_ENTRIES),
    },
)

# The card: the Drive Talk line of each port, and what it knows of the drive of each axis.
LINE = HiddenBlock(
    prefix="NETL",
    family="drive_talk_lines",
    count=PORTS,
    doubles=("due_tk",),
    ints=(
        "device",  # 0: not open
        "program",
        "baud",
        "character_bits",
        "axis",  # that was served last
        "request",  # what is being done, 0 nothing
        "selection",  # the control flags when it began
        "exchange",  # which of its exchanges
        "addressing",  # all axes have been asked to address their drives
        "answers",  # how many drives have answered
        "length",
        ("answer", ANSWER_LENGTH),
        "channel",  # of the terminal that talks to a drive, from 1 on
        "talks_to",
        "typed_count",
        ("typed", LINE_LENGTH),
    ),
    ranges={
        "axis": (-1, 16),
        "length": (0, ANSWER_LENGTH),
        "typed_count": (0, LINE_LENGTH),
        "program": (-1, 16),
    },
)

AXIS = HiddenBlock(
    prefix="NETD", family="drive_talk_axes", count=16, doubles=("limit_tk",), ints=("known",)
)

NETWORKS = HiddenBlock(
    prefix="NET",
    family="networks",
    count=1,
    doubles=(
        "due_tk",  # the slow side is wanted
        "look_tk",  # drives look for errors to log
    ),
)
