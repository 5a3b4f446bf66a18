"""Actions on the machine around a card: switch inputs, move loads by hand, cause faults.

Every action is recorded in the journal with its tick.
"""

import math
from typing import Protocol

from openacr.errors import UserError
from openacr.journal.entries import Entered
from openacr.map.rows import axes, encoders, stepper_motors
from openacr.motion.axis.attach import Feedback
from openacr.motion.card import Card
from openacr.motion.interlocks import scale_of
from openacr.plant import inputs
from openacr.plant.build import analogs, apply
from openacr.plant.bus import terminals
from openacr.plant.describe.schema import World
from openacr.plant.world import faults
from openacr.plant.world.fault_kinds import MachineFault

RAW_COUNTS = 4  # of an encoder per line, at MULT 4
_INPUTS = "inputs are " + ", ".join(f"{first}-{last}" for first, last in inputs.RANGES)


def needs_axis(card: Card, number: int) -> None:
    """UserError for an axis the card does not have."""
    if not 0 <= number < card.model.axes:
        known = f"the {card.model.name} has axes 0-{card.model.axes - 1}"
        raise UserError(f"axis {number}: {known}")


def _needs_finite(what: str, value: float) -> None:
    if not math.isfinite(value):
        raise UserError(f"{what}: {value} is not a finite number")


def _fault_kind(word: str) -> MachineFault:
    try:
        return MachineFault(word)
    except ValueError:
        raise UserError(f"fault {word!r}: known are {', '.join(MachineFault)}") from None


class Note(Protocol):
    """A function that records an action in the journals."""

    def __call__(self, what: Entered, number: int, value: float = 0.0, *, name: str = "") -> None:
        """Record the kind of action, its number, value and name."""


class Surroundings:
    """The machine around a card, on which a caller can act."""

    def __init__(self, card: Card, world: World, note: Note) -> None:
        self.card, self.world = card, world
        self.memory = card.memory
        self._note = note

    def set_input(self, bit: int, on: bool) -> None:
        """Switch an input, or force one driven by the machine; UserError if not an input."""
        self._needs_input(bit)
        inputs.switch(self.memory, bit, on)
        self._note(Entered.INPUT, bit, on)

    def release_input(self, bit: int) -> None:
        """Release a forced input: the machine drives it again; off if nothing drives it."""
        self._needs_input(bit)
        inputs.release(self.memory, bit)
        self._note(Entered.RELEASE, bit)

    def _needs_input(self, bit: int) -> None:
        if not inputs.exists(self.memory, bit):
            of_node = terminals.input_terminal(bit) is not None
            why = "no CANopen node of the machine has it" if of_node else _INPUTS
            raise UserError(f"input {bit}: {why}")

    def set_analog(self, parameter: int, value: float) -> None:
        """Apply a value, in its unit, to the analog input that a parameter shows."""
        _needs_finite(f"P{parameter}", value)
        channel = analogs.terminal(parameter)
        place = terminals.analog_input(self.memory, parameter)
        if channel is not None:
            analogs.put_volts(self.memory, channel, value)
        elif place is None:
            raise UserError(f"P{parameter} shows no analog input")
        else:
            self.memory.F[place] = value
        self._note(Entered.ANALOG, parameter, value)

    def drag(self, axis: int, by_u: float) -> None:
        """Move the load of an axis by hand, at once; the simulation continues from there."""
        needs_axis(self.card, axis)
        _needs_finite(f"axis {axis}", by_u)
        pulses = by_u * scale_of(self.card, axis)
        if not self._push(axis, pulses):
            row = axes.actual_position[axis]
            self.memory.write(row, self.memory.I[row] + round(pulses))
        self._note(Entered.DRAG, axis, by_u)

    def _push(self, axis: int, pulses: float) -> bool:
        """Move the motor of an axis; False if it has none."""
        rows = self.memory.I
        motor = rows[axes.position_index[axis]]
        if rows[axes.position_source[axis]] == Feedback.STEPPER:
            motor = rows[axes.drive_motor[axis]]
            if motor < 0:
                return False
            counts = pulses * self.memory.F[stepper_motors.counts_per_pulse[motor]]
        else:
            mult = rows[encoders.mult[motor]] or 1
            counts = pulses * RAW_COUNTS / mult
        return apply.push(self.memory, motor, counts)

    def fault(self, axis: int, kind: str, value: float = 0.0) -> None:
        """Cause a fault on an axis of the machine; it lasts until `mend`."""
        _needs_finite(f"axis {axis}", value)
        faults.inject(self.world, self.memory, axis, _fault_kind(kind), value)
        self._note(Entered.FAULT, axis, value, name=kind)

    def mend(self, axis: int, kind: str | None = None) -> None:
        """End one kind of fault of an axis, or all of them."""
        faults.mend(self.world, self.memory, axis, None if kind is None else _fault_kind(kind))
        self._note(Entered.MEND, axis, name=kind or "")
