"""All networks of a card, with the entry point for the engine when one needs service."""

from __future__ import annotations

from collections.abc import Callable

from openacr.map.memory import Memory
from openacr.map.rows import networks
from openacr.network.canopen import master as canopen
from openacr.network.drivetalk import service as drivetalk


class Networks:
    """The networks of one card; their entire state is in the map.

    `deliver` receives what a drive has sent for a channel connected to it.
    """

    def __init__(self, memory: Memory, deliver: Callable[[int, str], None]) -> None:
        self._memory = memory
        self._deliver = deliver

    def power_up(self) -> None:
        """Initialize after switching the card on."""
        canopen.power_up(self._memory)
        self._set_due()

    def attend(self) -> None:
        """Perform all actions that are due."""
        canopen.attend(self._memory)
        drivetalk.attend(self._memory, self._deliver)
        self._set_due()

    def _set_due(self) -> None:
        times = canopen.next_tk(self._memory), drivetalk.next_tk(self._memory)
        due_tk = min((time for time in times if time), default=0.0)
        self._memory.F[networks.due_tk] = due_tk
