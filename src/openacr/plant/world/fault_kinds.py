"""The kinds of faults of a machine, and the numbers that belong to them, with units and limits."""

from dataclasses import dataclass
from enum import StrEnum

from openacr.errors import UserError
from openacr.plant.describe.schema import Axis


class MachineFault(StrEnum):
    """The kinds of faults of an axis of the machine."""

    ENCODER_LOST = "encoder-lost"
    ENCODER_NOISE = "encoder-noise"
    DRIVE = "drive"
    MOTOR_CABLE = "motor-cable"
    JAM = "jam"
    OBSTACLE = "obstacle"
    FRICTION = "friction"
    SUPPLY = "supply"


@dataclass(frozen=True, slots=True)
class Quantity:
    """The number that belongs to a fault: its key in scenarios, its unit, its limits."""

    key: str
    what: str
    unit: str = ""  # "": that of the axis
    low: float | None = None
    is_low_included: bool = True
    hint: str = ""

    def check(self, axis: Axis, value: float, high: float | None) -> None:
        """UserError for a value outside the limits; `high` is that of the axis, if it has one."""
        is_low = self.low is not None and (
            value < self.low or (value == self.low and not self.is_low_included)
        )
        if is_low or (high is not None and value > high):
            hint = f" ({self.hint})" if self.hint else ""
            raise UserError(
                f"axis {axis.label}: {self.what} of {value:g} {self.unit};"
                f" {self.range_words(high)}{hint}"
            )

    def range_words(self, high: float | None) -> str:
        """The limits in words; "" without any."""
        if self.low is None:
            return ""
        if high is None:
            return f"it is {self.low:g} or more"
        return f"{'' if self.is_low_included else 'above '}{self.low:g} to {high:g} {self.unit}"


PLACE = Quantity("at", "an obstacle")
TORQUE = Quantity("torque_nm", "friction", "Nm", 0.0)
VOLTS = Quantity(
    "volts", "a supply", "V", 0.0, is_low_included=False,
    hint="without any voltage the fault is `motor-cable`",
)  # fmt: skip
