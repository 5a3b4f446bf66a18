"""The rows of the network master, under names."""

from __future__ import annotations

from enum import IntEnum

from openacr.map import numbers as at
from openacr.map.memory import Memory
from openacr.map.rows import network_slaves
from openacr.network import wake_cy
from openacr.network.times import later_tk, tick_of

SLAVES = at.NETS_COUNT
WORD = at.W_CAN
FAULTS = (
    at.CANF_NETWORK_START_FAILED
    | at.CANF_NODE_FAILURE
    | at.CANF_SW_RX_OVERFLOW
    | at.CANF_HW_RX_OVERFLOW
)


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
    """Reads and writes the rows of the master; it has no state of its own."""

    def __init__(self, memory: Memory) -> None:
        self.memory = memory

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
        self.memory.F[at.NETMF_BASE + row] = self.later_tk(after_ms)

    def time(self, row: int) -> float:
        """The tick at which something happens; 0 never."""
        return self.memory.F[at.NETMF_BASE + row]

    def stop_times(self) -> None:
        """Let nothing happen any more."""
        for row in TIMES:
            self.memory.F[at.NETMF_BASE + row] = 0.0
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
        self.memory.I[at.CAN_BASE + at.CAN_BUS_STATE] = state
        operational = at.CANF_NETWORK_OPERATIONAL
        self.change_flags(clear=operational)
        if state is BusState.STARTED:
            self.change_flags(set_=operational)

    def setting(self, row: int) -> int:
        """A parameter of the network."""
        return self.memory.I[at.CAN_BASE + row]

    def node_id(self, slave: int) -> int:
        """The id the user has given for a slave."""
        return self.memory.I[_shown(slave) + at.CANN_NODE_ID]

    def show_slave(self, slave: int, row: int, value: int) -> None:
        """Write one parameter of the node information."""
        self.memory.I[_shown(slave) + row] = value

    def shown_slave(self, slave: int, row: int) -> int:
        """Read one parameter of the node information."""
        return self.memory.I[_shown(slave) + row]

    # what the user does not see

    def get(self, row: int) -> int:
        """Read a hidden row of the master."""
        return self.memory.I[at.NETMI_BASE + row]

    def put(self, row: int, value: int) -> None:
        """Write a hidden row of the master."""
        self.memory.I[at.NETMI_BASE + row] = value

    @property
    def phase(self) -> Phase:
        """What the master is doing."""
        return Phase(self.get(at.NETMI_PHASE))

    def enter(self, phase: Phase) -> None:
        """Do something else."""
        self.put(at.NETMI_PHASE, phase)

    def slaves(self) -> range:
        """The slaves the network was started with."""
        return range(self.get(at.NETMI_SLAVES))

    def live_slaves(self) -> list[int]:
        """The slaves that have not failed."""
        return [slave for slave in self.slaves() if self.slave(slave, at.NETSI_LIVE)]

    def slave(self, slave: int, row: int) -> int:
        """Read a hidden row of a slave."""
        return self.memory.I[at.NETSI_BASE + slave * at.NETSI_STRIDE + row]

    def put_slave(self, slave: int, row: int, value: int) -> None:
        """Write a hidden row of a slave."""
        self.memory.I[at.NETSI_BASE + slave * at.NETSI_STRIDE + row] = value


TIMES = (at.NETMF_PHASE_TK, at.NETMF_SYNC_TK, at.NETMF_ARRIVAL_TK, at.NETMF_HEALTH_TK)


def _shown(slave: int) -> int:
    return at.CANN_BASE + slave * at.CANN_STRIDE
