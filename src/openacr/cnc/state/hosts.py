"""Interfaces of the interpreter to the outside: cells, card and machine.

`Cells` is the SYSVAR store (P100..P4095, P100000..P1003424), `Machine` everything that
only a machine knows. `VirtualMachine` answers for checks and previews, where nothing moves.
"""

from contextlib import AbstractContextManager
from dataclasses import dataclass, field
from typing import Protocol

from msgspec import Struct

from openacr.cnc.canonical import Point, Spin


class Home(Protocol):
    """Where a parameter is kept and who may use it."""

    @property
    def is_on_card(self) -> bool:
        """Whether the card keeps it: reads and writes wait for rest."""

    @property
    def read_error(self) -> str | None:
        """The code of the refusal when a program reads it, None if it may."""

    @property
    def write_warning(self) -> str | None:
        """The code of the warning when a program assigns it."""

    def write_error(self, *, is_service: bool = False) -> str | None:
        """The code of the refusal when a program assigns it, None if it may."""


class Cells(Protocol):
    """Numbered cells that outlive the run."""

    def home(self, n: int) -> Home:
        """Where a number lives."""

    def read(self, n: int) -> float:
        """The number in a cell."""

    def write(self, n: int, value: float) -> None:
        """Set a cell."""

    def read_text(self, n: int) -> str:
        """The text in a cell."""

    def transaction(self, *, is_durable: bool = True) -> AbstractContextManager[None]:
        """What is written inside is stored together, or not at all.

        `is_durable` waits for the disk; without it a power cut may lose the last ones.
        """


class Switched(Struct, frozen=True):
    """What a machine has switched on: direction and set speed of the spindle, and coolant."""

    spin: Spin = Spin.OFF
    rpm: float = 0.0
    has_mist: bool = False
    has_flood: bool = False


class Machine(Protocol):
    """The card and what is wired to it; asked only after a Sync."""

    def read_parameter(self, n: int) -> float:
        """A card parameter (P0..P99, P4096..P20487)."""

    def write_parameter(self, n: int, value: float) -> None:
        """Set a card parameter."""

    def read_bit(self, n: int) -> bool:
        """A card flag; inputs are flags 0..31, outputs 32..63."""

    def position(self) -> Point | None:
        """Where the axes stand (machine coordinates, default units); None: as programmed."""

    def tripped(self) -> Point | None:
        """Where the probe tripped in the last Probe, None when it did not."""

    def answer(self, parameter: int) -> float | None:
        """What the operator answered to the last Ask."""

    def is_block_skip_on(self) -> bool:
        """Whether blocks with a slash are left out."""

    def is_homed(self, axis: int) -> bool:
        """Whether an axis knows its reference point."""

    def has_probe(self) -> bool:
        """Whether a probe input is configured."""

    def switched(self) -> Switched:
        """Spindle and coolant as they are now."""


@dataclass
class VirtualMachine:
    """A machine for checks and previews: own cells, no probe trips, no answers."""

    is_skipping: bool = False
    is_probed: bool = True
    parameters: dict[int, float] = field(default_factory=dict)
    bits: set[int] = field(default_factory=set)

    def read_parameter(self, n: int) -> float:
        """A value that was written before, or 0."""
        return self.parameters.get(n, 0.0)

    def write_parameter(self, n: int, value: float) -> None:
        """Keep a value."""
        self.parameters[n] = value

    def read_bit(self, n: int) -> bool:
        """Off unless listed."""
        return n in self.bits

    def position(self) -> Point | None:
        """Where the program has brought it."""
        return None

    def tripped(self) -> Point | None:
        """Nothing ever trips."""
        return None

    def answer(self, parameter: int) -> float | None:
        """None: there is no operator."""
        return None

    def is_block_skip_on(self) -> bool:
        """As set."""
        return self.is_skipping

    def is_homed(self, axis: int) -> bool:
        """Taken for granted."""
        return True

    def has_probe(self) -> bool:
        """As set."""
        return self.is_probed

    def switched(self) -> Switched:
        """Nothing is on."""
        return Switched()
