"""Results of a run as plain data: events, axes, and the values chosen for recording."""

from typing import TYPE_CHECKING

from msgspec import Struct

from openacr.errors import UserError

if TYPE_CHECKING:
    from openacr.engine.samples import Sample
    from openacr.map.memory import Memory


class Event(Struct, frozen=True):
    """One thing that happened."""

    time_s: float
    text: str
    flag: int | None = None
    program: int | None = None

    def __str__(self) -> str:
        return f"{self.time_s:.4f} s: {self.text}"


class AxisReport(Struct, frozen=True):
    """One axis at the end of a run, and the extremes it reached."""

    number: int
    position_u: float
    actual_u: float
    distance_u: float
    peak_velocity_ups: float
    peak_following_error_u: float


class Watched(Struct, frozen=True):
    """One recorded value: its column in a trace, its title in a picture."""

    column: str  # P12290, BIT516
    title: str  # of a flag its name alone, as pictures show its number themselves
    unit: str
    is_flag: bool
    number: int

    def sample(self, memory: "Memory") -> "Sample":
        """What the card records; UserError where this card has no such parameter."""
        from openacr.engine.samples import sample_of_flag, sample_of_parameter

        found = (
            sample_of_flag(self.number)
            if self.is_flag
            else sample_of_parameter(memory, self.number)
        )
        if found is None:
            raise UserError(f"--watch {self.column}: this card has no such parameter")
        return found
