"""Write the CANopen nodes of a world into the memory of a card."""

from openacr.map import numbers as at
from openacr.map.memory import Memory
from openacr.plant import bus
from openacr.plant.network_schema import Coupler, Fault, FaultKind, Health, Node
from openacr.plant.schema import World

COUPLERS = {Coupler.PIO_337: 0, Coupler.PIO_347: 1}
HEALTH = {Health.HEARTBEAT: 1, Health.GUARDING: 2}
TROUBLES = {
    FaultKind.SILENT: bus.Trouble.SILENT,
    FaultKind.LOST: bus.Trouble.LOST,
    FaultKind.NOISE: bus.Trouble.NOISE,
    FaultKind.CONTROLLER: bus.Trouble.CONTROLLER,
    FaultKind.SOFTWARE_OVERFLOW: bus.Trouble.SOFTWARE_OVERFLOW,
    FaultKind.HARDWARE_OVERFLOW: bus.Trouble.HARDWARE_OVERFLOW,
}
REALS = (
    (at.BUSNF_BASE, at.BUSN_COUNT * at.BUSNF_STRIDE),
    (at.BUSXF_BASE, at.BUSX_COUNT * at.BUSXF_STRIDE),
    (at.BUSF_BASE, at.BUSF_STRIDE),
)
INTS = (
    (at.BUSNI_BASE, at.BUSN_COUNT * at.BUSNI_STRIDE),
    (at.BUSXI_BASE, at.BUSX_COUNT * at.BUSXI_STRIDE),
    (at.BUSI_BASE, at.BUSI_STRIDE),
)


def write_nodes(memory: Memory, world: World) -> None:
    """Put the nodes of a world on the bus, their outputs off."""
    if world.canopen is None:
        return
    memory.I[at.BUSI_BASE + at.BUSI_FITTED] = 1
    places = {node.id: place for place, node in enumerate(world.canopen.node)}
    for place, node in enumerate(world.canopen.node):
        _write_node(memory, place, node)
    for place, fault in enumerate(world.canopen.fault):
        _write_fault(memory, place, fault, places)
    for place in places.values():
        bus.begin(memory, place, bus.NodeState.PRE_OPERATIONAL)
    bus.follow_power(memory)


def _write_node(memory: Memory, place: int, node: Node) -> None:
    ints = {
        at.BUSNI_ID: node.id,
        at.BUSNI_BIT_RATE: int(node.bit_rate),
        at.BUSNI_COUPLER: COUPLERS[node.coupler],
        at.BUSNI_HEALTH: HEALTH[node.health],
        at.BUSNI_DIGITAL_INPUTS: node.digital_inputs,
        at.BUSNI_DIGITAL_OUTPUTS: node.digital_outputs,
        at.BUSNI_ANALOG_INPUTS: node.analog_inputs,
        at.BUSNI_ANALOG_OUTPUTS: node.analog_outputs,
        at.BUSNI_ANALOG_BITS: node.analog_bits,
    }
    for row, number in ints.items():
        memory.I[bus.ints(place) + row] = number
    reals = {
        at.BUSNF_INPUT_LOW: node.input_range[0],
        at.BUSNF_INPUT_HIGH: node.input_range[1],
        at.BUSNF_OUTPUT_LOW: node.output_range[0],
        at.BUSNF_OUTPUT_HIGH: node.output_range[1],
        **{at.BUSNF_MEASURED + n: value for n, value in enumerate(node.analog_values)},
    }
    for row, value in reals.items():
        memory.F[bus.reals(place) + row] = value


def _write_fault(memory: Memory, place: int, fault: Fault, places: dict[int, int]) -> None:
    ints = at.BUSXI_BASE + place * at.BUSXI_STRIDE
    memory.I[ints + at.BUSXI_KIND] = TROUBLES[fault.kind]
    memory.I[ints + at.BUSXI_NODE] = places.get(fault.node or 0, 0)
    reals = at.BUSXF_BASE + place * at.BUSXF_STRIDE
    memory.F[reals + at.BUSXF_FROM_S] = fault.at_s
    memory.F[reals + at.BUSXF_UNTIL_S] = bus.NEVER_S if fault.until_s is None else fault.until_s
    memory.F[reals + at.BUSXF_RATE] = fault.rate
