"""I/O nodes of the profile CiA 401 on a CAN bus, with the terminals of modelled nodes.

What is at the terminals, what drives them and the faults of nodes are those of `[canopen]` in a
machine file; here is what such a node says on a bus.
"""

from openacr.fieldbus.canopen.emulated_objects import Objects
from openacr.fieldbus.canopen.frames import Cob, Frame, Link, Nmt, NodeState
from openacr.fieldbus.canopen.io_node import EACH_SYNC, GUARDING, ON_CHANGE
from openacr.map.memory import Memory, flag_place
from openacr.map.rows import bus_nodes, system
from openacr.plant.build.apply_networks import write_nodes
from openacr.plant.bus import bus, terminals
from openacr.plant.describe.network_schema import Canopen
from openacr.plant.describe.schema import World

STATES = {
    Nmt.START: NodeState.OPERATIONAL,
    Nmt.STOP: NodeState.STOPPED,
    Nmt.PRE_OPERATIONAL: NodeState.PRE_OPERATIONAL,
}


class EmulatedNodes:
    """The nodes of a machine on a bus; `attend` serves what has arrived."""

    def __init__(self, world: World, link: Link) -> None:
        self.memory = Memory()
        write_nodes(self.memory, world)
        self._link = link
        self._start_s = link.now_s()
        canopen = world.canopen or Canopen()
        self.nodes = [
            EmulatedNode(self.memory, place, link)
            for place in bus.nodes(self.memory)
            if not canopen.node[place].modelled
        ]

    def attend(self) -> None:
        """Serve all frames that have arrived, and send what is due."""
        self.memory.F[system.time_s] = self._link.now_s() - self._start_s
        bus.follow_power(self.memory)
        frames = self._link.take()
        for node in self.nodes:
            node.follow()
            for frame in frames:
                node.hear(frame)
            node.look(self._link.now_s())


class EmulatedNode:
    """One node."""

    def __init__(self, memory: Memory, place: int, link: Link) -> None:
        self.memory, self.place, self._link = memory, place, link
        self.is_cut = self.is_disconnected = False  # by an order
        rows = memory.I
        self.id = rows[bus_nodes.id[place]]
        self._guarded = rows[bus_nodes.health[place]] == GUARDING
        self.state: NodeState | None = None  # None: no power
        self._begin()

    def _begin(self) -> None:
        """Power-up or reset: everything as delivered."""
        self.objects = Objects(self.memory, self.place)
        self._guard_toggle = False
        self._sent_inputs: dict[int, bytes] = {}
        self._arrived: dict[int, bytes] = {}  # outputs that wait for the synchronisation
        self._beat_s = self._link.now_s()
        bus.begin(self.memory, self.place, bus.NodeState.PRE_OPERATIONAL)
        self.state = NodeState.PRE_OPERATIONAL
        self._send(Cob.HEALTH + self.id, bytes((NodeState.BOOT,)))

    # what happens

    def follow(self) -> None:
        """Follow the power of the node."""
        has_power = self.memory.I[bus_nodes.state[self.place]] != bus.NodeState.OFF
        is_on = has_power and not self.is_cut
        if is_on and self.state is None:
            self._begin()
        elif not is_on and self.state is not None:
            self.state = None
            if has_power:  # outputs drop
                bus.begin(self.memory, self.place, bus.NodeState.PRE_OPERATIONAL)

    @property
    def outputs(self) -> int:
        """The number of digital outputs."""
        return self.memory.I[bus_nodes.digital_outputs[self.place]]

    def output(self, number: int) -> bool:
        """Whether a digital output is on."""
        word = terminals.terminal_row(self.place, number, bus_nodes.outputs)
        return bool(self.memory.I[word] >> number % 32 & 1)

    def set_input(self, number: int, is_on: bool) -> None:
        """Switch a digital input at its terminal."""
        word = terminals.terminal_row(self.place, number, bus_nodes.levels)
        mask = flag_place(number)[1]
        level = self.memory.I[word]
        self.memory.I[word] = level | mask if is_on else level & ~mask

    def emergency(self, code: int) -> None:
        """Report an emergency."""
        if not self._is_silent:
            self._send(Cob.EMERGENCY + self.id, code.to_bytes(2, "little") + bytes(6))

    @property
    def _is_silent(self) -> bool:
        is_away = self.is_disconnected or bus.has_fault(self.memory, bus.Trouble.SILENT, self.place)
        return self.state is None or is_away

    def hear(self, frame: Frame) -> None:
        """A frame of the bus."""
        if self._is_silent:
            return
        if frame.id == Cob.NMT and len(frame.data) >= 2:
            if frame.data[1] in (0, self.id):
                self._command(frame.data[0])
        elif frame.id == Cob.SDO + self.id and self.state is not NodeState.STOPPED:
            answer = self.objects.serve(frame.data)
            if answer is not None:
                self._send(Cob.SDO_ANSWER + self.id, answer)
        elif frame.id == Cob.HEALTH + self.id and frame.is_remote and self._guarded:
            state = (self.state or 0) | self._guard_toggle << 7
            self._guard_toggle = not self._guard_toggle
            self._send(Cob.HEALTH + self.id, bytes((state,)))
        elif self.state is NodeState.OPERATIONAL:
            if frame.id == Cob.SYNC:
                self._sync()
            elif not frame.is_remote:
                self._arrived |= {
                    pdo: frame.data
                    for pdo in self.objects.pdos(0x1400)
                    if self.objects.cob(0x1400, pdo) == frame.id
                }

    def look(self, now_s: float) -> None:
        """Send a heartbeat that is due, and digital inputs that have changed."""
        if self._is_silent:
            return
        period_s = int.from_bytes(self.objects.values.get((0x1017, 0), b""), "little") / 1000
        if period_s and now_s - self._beat_s >= period_s:
            self._beat_s = now_s
            self._send(Cob.HEALTH + self.id, bytes((self.state or 0,)))
        if self.state is NodeState.OPERATIONAL:
            for pdo in self.objects.pdos(0x1800):
                if self.objects.values[0x1800 + pdo, 2][0] == ON_CHANGE:
                    self._send_inputs(pdo, only_new=True)

    def _command(self, command: int) -> None:
        if command in STATES:
            self.state = STATES[Nmt(command)]
            if self.state is NodeState.OPERATIONAL:
                bus.run(self.memory, self.place)
                self._sent_inputs.clear()
            else:
                bus.stop(self.memory, self.place)
        elif command == Nmt.RESET:
            self._begin()

    def _sync(self) -> None:
        for pdo, data in self._arrived.items():
            at = 0
            for index, subindex, size in self.objects.mapped(0x1600 + pdo):
                if len(data) >= at + size:
                    self.objects.put(index, subindex, data[at : at + size])
                at += size
        self._arrived.clear()
        for pdo in self.objects.pdos(0x1800):
            if self.objects.values[0x1800 + pdo, 2][0] == EACH_SYNC:
                self._send_inputs(pdo)

    def _send_inputs(self, pdo: int, *, only_new: bool = False) -> None:
        data = b"".join(
            self.objects.get(index, sub) for index, sub, _ in self.objects.mapped(0x1A00 + pdo)
        )
        if not only_new or self._sent_inputs.get(pdo) != data:
            self._sent_inputs[pdo] = data
            self._send(self.objects.cob(0x1800, pdo), data)

    def _send(self, identifier: int, data: bytes) -> None:
        self._link.send(Frame(identifier, data))
