"""Hidden rows of the networks: nodes and drives on them, and what the card knows of both.

`BUS` rows are part of the world outside, which a restart of the card leaves alone; `NET` rows
belong to the card. Ticks are float64 numbers; 0 stands for never.
"""

from openacr.map.hidden.block import HiddenBlock

NODES = 4
WORDS_PER_NODE = 16
ANALOG_CHANNELS = 32

# The world: node n of the machine file.
NODE = HiddenBlock(
    prefix="BUSN",
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
)

FAULT = HiddenBlock(
    prefix="BUSX",
    count=16,
    doubles=("from_s", "until_s", "rate"),
    ints=("kind", "node"),
)

BUS = HiddenBlock(
    prefix="BUS",
    count=1,
    doubles=("before_s",),  # lived before the card was switched on the last time
    ints=("fitted",),  # the card has a CANopen controller
)

# The card: its network master, and each of its slave nodes.
MASTER = HiddenBlock(
    prefix="NETM",
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
)

SLAVE = HiddenBlock(
    prefix="NETS",
    count=NODES,
    doubles=("change_tk",),  # a message with changed inputs arrives
    ints=(
        "node",  # which node of the world it is
        "live",
        "words",  # of its digital inputs
        ("sent", WORDS_PER_NODE),  # inputs the node has sent last
        ("latched", ANALOG_CHANNELS),  # counts of its inputs at the last sync
    ),
)

NETWORKS = HiddenBlock(prefix="NET", count=1, doubles=("due_tk",))
