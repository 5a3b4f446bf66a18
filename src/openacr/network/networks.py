"""All networks of a card: what the engine calls when one of them needs the slow side."""

from __future__ import annotations

from openacr.map import numbers as at
from openacr.map.memory import Memory
from openacr.network.canopen import master as canopen


class Networks:
    """The networks of one card; their whole state is in the map."""

    def __init__(self, memory: Memory) -> None:
        self._memory = memory

    def power_up(self) -> None:
        """Begin after switching the card on."""
        canopen.power_up(self._memory)
        self._set_due()

    def attend(self) -> None:
        """Do everything that is due."""
        canopen.attend(self._memory)
        self._set_due()

    def _set_due(self) -> None:
        self._memory.F[at.NETF_BASE + at.NETF_DUE_TK] = canopen.next_tk(self._memory)
