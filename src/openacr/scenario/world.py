"""The card and its machine as a scenario reads and acts on them."""

from typing import Protocol

from openacr.scenario.schema import State


class Surroundings(Protocol):
    """What a person or a mishap does to the machine around a card."""

    def set_input(self, bit: int, on: bool) -> None:
        """Switch one input; one that the machine drives is forced until it is released."""

    def release_input(self, bit: int) -> None:
        """Release an input: off, or the level the machine drives it to."""

    def drag(self, axis: int, by_u: float) -> None:
        """Move the load of an axis by hand, at once."""

    def set_analog(self, parameter: int, value: float) -> None:
        """Apply a value to the analog input a parameter shows."""

    def fault(self, axis: int, kind: str, value: float) -> None:
        """Cause a fault on an axis of the machine."""

    def mend(self, axis: int, kind: str | None) -> None:
        """End one kind of fault of an axis, or all."""

    def command(self, device: str, name: str, value: float) -> None:
        """Give a command to a device of the machine by hand."""


class World(Protocol):
    """The interface through which a scenario reads and acts on the card and its machine."""

    @property
    def tick(self) -> int:
        """Servo periods since the start."""

    def read(self, parameter: int) -> float:
        """Read one parameter."""

    def bit(self, number: int) -> bool:
        """Read one flag."""

    def position_u(self, axis: int) -> float:
        """Read the actual position of an axis in units."""

    def commanded_u(self, axis: int) -> float:
        """Read the commanded position of an axis in units."""

    def program_state(self, program: int) -> State:
        """Return the state of a program."""

    def type_text(self, text: str, stream: str | None) -> None:
        """Type text on a stream."""

    @property
    def surroundings(self) -> Surroundings:
        """The machine around the card, on which a scenario acts."""
