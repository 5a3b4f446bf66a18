"""What a path can be coloured by: names and units alone, because the command line needs them."""

from enum import StrEnum


class Quantity(StrEnum):
    """Magnitude of a derivative of the position by time, in the order of the derivatives."""

    SPEED = "speed"
    ACCELERATION = "acceleration"
    JERK = "jerk"

    def unit(self, length: str) -> str:
        """Its unit with a unit of length; speeds are per minute, as feeds are."""
        return length + {"speed": "/min", "acceleration": "/s²", "jerk": "/s³"}[self]
