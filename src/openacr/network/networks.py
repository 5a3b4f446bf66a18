"""All networks of a card, with the entry point for the engine when one needs service."""

from __future__ import annotations

from collections.abc import Callable

from openacr.map.memory import Memory
from openacr.map.rows import networks
from openacr.network.canopen import master as canopen
from openacr.network.canopen import startup
from openacr.network.canopen.nodes import Nodes
from openacr.network.drivetalk import service as drivetalk
from openacr.network.drivetalk.real import RealDrives


class Networks:
    """The networks of one card; their entire state is in the map, but that of real nodes.

    `deliver` receives what a drive has sent for a channel connected to it.
    """

    def __init__(self, memory: Memory, deliver: Callable[[int, str], None]) -> None:
        self._memory = memory
        self._deliver = deliver
        self.canopen = canopen.made(memory)
        self._drives: RealDrives | None = None

    def power_up(self) -> None:
        """Initialize after switching the card on."""
        startup.power_up(self.canopen)
        self._set_due()

    def connect(self, nodes: Nodes) -> None:
        """Look for all nodes that are not modelled on this bus as well."""
        self.canopen.buses = (*self.canopen.buses, nodes)
        self._set_due()

    def connect_drives(self, drives: RealDrives) -> None:
        """Talk to these drives instead of modelled ones."""
        self._drives = drives

    def attend(self) -> None:
        """Perform all actions that are due."""
        canopen.attend(self.canopen)
        drivetalk.attend(self._memory, self._deliver, self._drives)
        self._set_due()

    def _set_due(self) -> None:
        times = canopen.next_tk(self.canopen), drivetalk.next_tk(self._memory)
        due_tk = min((time for time in times if time), default=0.0)
        self._memory.F[networks.due_tk] = due_tk
