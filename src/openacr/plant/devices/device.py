"""The interface of a device: what it is given at every step, and what it answers."""

from collections.abc import Mapping
from typing import ClassVar

from msgspec import Struct

Value = bool | float  # of a command or signal: a contact, or volts (a position, for a command)
Values = Mapping[str, Value]


ROUNDING = 1e-9  # share of a step that sums of steps may be off


def ramp(value: float, goal: float, change: float) -> float:
    """A value one step of `change` nearer to a goal; the last step ends on it exactly."""
    if abs(goal - value) <= change * (1.0 + ROUNDING):
        return goal
    return value + change if goal > value else value - change


class Device(Struct, forbid_unknown_fields=True):
    """A device of a machine: subclass it, name commands and signals, and write `step`.

    Fields are settings, which `settings` in machine.toml may change; fields whose names begin
    with `_` are the state, which a snapshot of the card keeps: numbers, texts, lists of them.
    A device that uses nothing but its fields and the values it is given (no clock, no random
    numbers without a seed of its own, no files) behaves the same in every run.
    """

    COMMANDS: ClassVar[Mapping[str, type]] = {}  # name: bool or float
    SIGNALS: ClassVar[Mapping[str, type]] = {}

    def step(self, dt_s: float, commands: Values) -> Values:
        """Let `dt_s` seconds pass; the signals at their end (those left out keep their value).

        `commands` has every name of COMMANDS: the output, the volts or the position that is
        wired to it, otherwise what was set by hand, at first False or 0.0.
        """
        raise NotImplementedError(f"{type(self).__name__} has no step")
