"""Positions of an axis as counts of its encoder, and back."""

from openacr.plant.describe.schema import Axis


def count_of(axis: Axis, position_u: float) -> float:
    """Return the encoder count, with its fraction, at a position in user units."""
    return axis.encoder_direction.sign * (position_u - axis.initial) * axis.counts_per_unit + 0.5


def position_of(axis: Axis, count: float) -> float:
    """Return the position in user units at an encoder count."""
    return axis.initial + axis.encoder_direction.sign * (count - 0.5) / axis.counts_per_unit
