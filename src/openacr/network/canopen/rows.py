"""The rows of the network master, under names."""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING

from openacr.map import numbers as at
from openacr.map.memory import Memory
from openacr.map.rows import canopen, canopen_nodes, network_master, network_slaves
from openacr.map.words import canf
from openacr.network import wake_cy
from openacr.network.times import later_tk, tick_of

if TYPE_CHECKING:
    from openacr.network.canopen.nodes import Nodes

SLAVES = network_slaves.COUNT
WORD = at.W_CAN
FAULTS = canf.NETWORK_START_FAILED | canf.NODE_FAILURE | canf.SW_RX_OVERFLOW | canf.HW_RX_OVERFLOW


class BusState(IntEnum):
    """P32779."""

    PRE_INITIALIZED = 0
    PRE_OPERATIONAL = 1
    STARTED = 2
    INVALID_MASTER = 3
    INVALID_NODES = 4
    CHARACTERIZATION_ERROR = 5
    EXCESS_ERRORS = 6
    HEALTH_EVENT = 7
    INTERNAL_ERROR = 8
    TRANSMISSION_OVERFLOW = 9
    BUS_OFF = 10


class Phase(IntEnum):
    """What the master is doing."""

    ABSENT = 0
    POWER_UP = 1
    IDLE = 2
    INTERROGATING = 3
    RESETTING = 4
    RUNNING = wake_cy.RUNNING


class Master:
    """Reads and writes the rows of the master; knows the buses, and which slave is on which."""

    def __init__(self, memory: Memory) -> None:
        self.memory = memory
        self.buses: tuple[Nodes, ...] = ()
        self._bus_of: dict[int, Nodes] = {}

    def nodes(self, slave: int) -> Nodes:
        """The bus of a slave: the first one, unless it was looked for on another."""
        return self._bus_of.get(slave, self.buses[0])

    def look_on(self, bus: Nodes, slave: int) -> None:
        """Look for a slave on a bus from now on."""
        self._bus_of[slave] = bus

    # time

    @property
    def tick(self) -> int:
        """The present tick."""
        return tick_of(self.memory)

    def later_tk(self, after_ms: float) -> int:
        """The tick so much later, at least the next."""
        return later_tk(self.memory, after_ms)

    def set_time(self, row: int, after_ms: float) -> None:
        """Let something happen so much later."""
        self.memory.F[row] = self.later_tk(after_ms)

    def time(self, row: int) -> float:
        """The tick at which something happens; 0 never."""
        return self.memory.F[row]

    def stop_times(self) -> None:
        """Let nothing happen any more."""
        for row in TIMES:
            self.memory.F[row] = 0.0
        for slave in range(SLAVES):
            self.memory.F[network_slaves.change_tk[slave]] = 0.0

    def is_due(self, row: int) -> bool:
        """Whether it happens now."""
        return 0.0 < self.time(row) <= self.tick

    # what the user sees

    def flags(self) -> int:
        """The control and status flags."""
        return self.memory.I[WORD]

    def change_flags(self, *, set_: int = 0, clear: int = 0) -> None:
        """Clear flags and set others."""
        self.memory.I[WORD] = self.memory.I[WORD] & ~clear | set_

    def show(self, state: BusState) -> None:
        """Show a bus state; the network is operational in one state only."""
        self.memory.I[canopen.bus_state] = state
        operational = canf.NETWORK_OPERATIONAL
        self.change_flags(clear=operational)
        if state is BusState.STARTED:
            self.change_flags(set_=operational)

    def setting(self, row: int) -> int:
        """A parameter of the network."""
        return self.memory.I[row]

    def node_id(self, slave: int) -> int:
        """The id the user has given for a slave."""
        return self.memory.I[canopen_nodes.node_id[slave]]

    def show_slave(self, slave: int, row: tuple[int, ...], value: int) -> None:
        """Write one parameter of the node information."""
        self.memory.I[row[slave]] = value

    def shown_slave(self, slave: int, row: tuple[int, ...]) -> int:
        """Read one parameter of the node information."""
        return self.memory.I[row[slave]]

    # what the user does not see

    def get(self, row: int) -> int:
        """Read a hidden row of the master."""
        return self.memory.I[row]

    def put(self, row: int, value: int) -> None:
        """Write a hidden row of the master."""
        self.memory.I[row] = value

    @property
    def phase(self) -> Phase:
        """What the master is doing."""
        return Phase(self.get(network_master.phase))

    def enter(self, phase: Phase) -> None:
        """Do something else."""
        self.put(network_master.phase, phase)

    def slaves(self) -> range:
        """The slaves the network was started with."""
        return range(self.get(network_master.slaves))

    def live_slaves(self) -> list[int]:
        """The slaves that have not failed."""
        return [slave for slave in self.slaves() if self.slave(slave, network_slaves.live)]

    def forget_slave(self, slave: int) -> None:
        """Count a slave as failed, or not found yet."""
        self.put_slave(slave, network_slaves.live, 0)

    def slave(self, slave: int, row: tuple[int, ...], place: int = 0) -> int:
        """Read a hidden row of a slave, or one place of an array row."""
        return self.memory.I[row[slave] + place]

    def put_slave(self, slave: int, row: tuple[int, ...], value: int, place: int = 0) -> None:
        """Write a hidden row of a slave, or one place of an array row."""
        self.memory.I[row[slave] + place] = value


TIMES = (
    network_master.phase_tk,
    network_master.sync_tk,
    network_master.arrival_tk,
    network_master.health_tk,
)
