"""What the master of the card needs of a bus: the nodes on it, modelled or real."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

from openacr.plant.bus.bus import Found


class Pending:
    """The answer of a node that has not said everything yet."""


PENDING = Pending()
Outputs = tuple[list[int], list[int]]  # words of digital outputs, counts of analog ones


class Nodes(Protocol):
    """The nodes of a bus. A node is named by the slave (0 to 3) that it is for the card."""

    def attend(self) -> None:
        """Take notice of what has happened since the last call."""

    def next_tk(self) -> float:
        """The tick at which to call again; 0 if only a request makes that necessary."""

    def has(self, identity: int) -> bool:
        """Whether a node with this id is known to be on the bus, without asking for it."""

    def has_failed(self) -> bool:
        """Whether the controller of the bus is broken; asked before each start and reset."""

    def reset(self) -> None:
        """Let all nodes begin anew, as after power-up."""

    def stop(self) -> None:
        """Make all nodes pre-operational: a start has begun."""

    def ask(self, slave: int) -> float:
        """Begin to ask a node what it has; after how many ms to look for the answer."""

    def answer(self, slave: int) -> Found | Pending | None:
        """What the node has answered; None if it is not there, or not the one it has to be."""

    def run(self, slave: int) -> None:
        """Make a node operational."""

    def answers(self, slave: int) -> bool:
        """Whether a node takes part in the exchange."""

    def is_well(self, slave: int) -> bool:
        """Whether a node has reported its health; asked once in a health period."""

    def outputs(self, slave: int) -> tuple[int, int]:
        """How many digital and analog outputs a node has."""

    def exchange(self, outputs: Mapping[int, Outputs]) -> None:
        """One cycle: outputs of the slaves that answer, and the synchronisation."""

    def digital(self, slave: int) -> list[int] | None:
        """The words of digital inputs that a node has sent; None if there is nothing new."""

    def analog(self, slave: int) -> list[int] | None:
        """The counts of analog inputs that a node has sent; None if there is nothing new."""

    def notice(self, slave: int) -> None:
        """Let a node send digital inputs that have changed."""

    def destroyed(self) -> float:
        """The share of messages that were destroyed in this cycle."""

    def errors(self) -> int:
        """How high the error counter of the controller is at least: 0, 96 (warning), 256 (off)."""
