"""Axes and masters with their parameters as attributes.

`Quantity` is one parameter of an object. Reading the attribute returns what reading a
parameter returns: a number for `Card`, an awaitable of a number for `AsyncCard`.
"""

from collections.abc import Callable
from typing import Generic, TypeVar, overload

from openacr.client.names import What, flag_number, parameter_number
from openacr.client.values import Number

R = TypeVar("R")  # result of reading a number
B = TypeVar("B")  # result of reading a flag
W = TypeVar("W")  # result of writing


class Thing(Generic[R, B, W]):
    """One numbered object of a card."""

    word = ""

    def __init__(
        self,
        number: int,
        read: Callable[[What], R],
        read_bit: Callable[[What], B],
        write: Callable[[What, Number], W],
        write_bit: Callable[[What, bool], W],
    ) -> None:
        self.number = number
        self._read, self._read_bit = read, read_bit
        self._write, self._write_bit = write, write_bit

    def read(self, name: str) -> R:
        """Any parameter of the object by its name, e.g. `"following error"`."""
        return self._read(self.parameter(name))

    def write(self, name: str, value: Number) -> W:
        """Set a parameter of the object."""
        return self._write(self.parameter(name), value)

    def flag(self, name: str) -> B:
        """Any flag of the object by its name, e.g. `"jog active"`."""
        return self._read_bit(self.flag_number(name))

    def set_flag(self, name: str, on: bool = True) -> W:
        """Set or clear a flag of the object."""
        return self._write_bit(self.flag_number(name), on)

    def parameter(self, name: str) -> int:
        """The number of a parameter of the object."""
        return parameter_number(f"{self.word}{self.number}.{name}")

    def flag_number(self, name: str) -> int:
        """The number of a flag of the object."""
        return flag_number(f"{self.word}{self.number}.{name}")

    def __repr__(self) -> str:
        return f"{self.word}{self.number}"


class _Named:
    """A parameter or flag of an object by its name."""

    def __init__(self, name: str, doc: str) -> None:
        self.name = name
        self.__doc__ = doc


class Quantity(_Named):
    """A parameter of an object."""

    @overload
    def __get__(self, thing: None, owner: type) -> "Quantity": ...
    @overload
    def __get__(self, thing: Thing[R, B, W], owner: type) -> R: ...
    def __get__(self, thing: "Thing[R, B, W] | None", owner: type) -> "R | Quantity":
        return self if thing is None else thing.read(self.name)

    def __set__(self, thing: Thing[R, B, W], value: Number) -> None:
        raise AttributeError(f'use write("{self.name}", {value})')


class Condition(_Named):
    """A flag of an object."""

    @overload
    def __get__(self, thing: None, owner: type) -> "Condition": ...
    @overload
    def __get__(self, thing: Thing[R, B, W], owner: type) -> B: ...
    def __get__(self, thing: "Thing[R, B, W] | None", owner: type) -> "B | Condition":
        return self if thing is None else thing.flag(self.name)


class Axis(Thing[R, B, W]):
    """One axis; positions in pulses, as the card stores them (`ppu` pulses are one unit)."""

    word = "axis"

    current_position = Quantity("current position", "Commanded position, no jog offset [pulses].")
    target_position = Quantity("target position", "End of the current move [pulses].")
    actual_position = Quantity("actual position", "Encoder position [pulses].")
    following_error = Quantity("following error", "Commanded minus actual position [pulses].")
    primary_setpoint = Quantity("primary setpoint", "Commanded position with offsets [pulses].")
    jog_offset = Quantity("jog offset", "Offset accumulated by jogs [pulses].")
    output_signal = Quantity("output signal", "Signal to the drive [V].")
    ppu = Quantity("ppu", "Pulses per unit.")
    is_enabled = Condition("drive enabled", "The drive is on.")
    is_killed = Condition("kill all motion request", "All motion of the axis is inhibited.")
    is_jogging = Condition("jog active", "A jog moves the axis.")


class Master(Thing[R, B, W]):
    """One master: the coordinated motion of its axes."""

    word = "master"

    vector_velocity = Quantity("vector velocity", "Present speed along the path [units/s].")
    distance_to_go = Quantity("distance to go", "Distance to the end of the current move [units].")
    feedrate_override = Quantity("feedrate override", "Factor on all speeds (FOV).")
    move_counter = Quantity("move counter", "Count of moves started.")
    is_in_motion = Condition("in motion", "A coordinated move is in progress.")
    is_killed = Condition("kill all moves request", "Moves are inhibited.")
