"""What a run needs of a card, and that card as a scenario sees it."""

from collections.abc import Callable, Sequence
from math import nan
from typing import TYPE_CHECKING, Protocol

from openacr.cli.results import AxisReport, Event, Failure, Watched
from openacr.cli.run import card_view
from openacr.errors import CardError
from openacr.map.memory import Memory
from openacr.scenario import Condition, State

if TYPE_CHECKING:
    from openacr.cli.plots import Curves


class Machine(Protocol):
    """A card with its project loaded, at rest between two ticks."""

    @property
    def memory(self) -> Memory:
        """All parameters and flags."""

    @property
    def tick(self) -> int:
        """Servo periods lived so far."""

    @property
    def time_s(self) -> float:
        """Simulated seconds lived so far."""

    @property
    def period_s(self) -> float:
        """Seconds per tick."""

    def digest(self) -> str:
        """Fingerprint of the whole state."""

    def watch(self, conditions: Sequence[Condition]) -> bool:
        """Make `advance` end when one of these may have changed; False if that is too much."""

    def has_new_events(self) -> bool:
        """Whether axes or programs have come into use since `watch`: call it once more."""

    def events(self) -> Sequence[Event]:
        """What happened to the machine since the last call."""

    def advance(self, ticks: int) -> None:
        """Run the card for `ticks` ticks, fewer if something watched changes."""

    def advance_until(self, bit: int, is_on: bool, ticks: int) -> bool:
        """Run the card until a flag has this state, but no longer than `advance` would."""

    def listen(self, hear: Callable[[str], None], overhear: Callable[[str], None]) -> None:
        """Call `hear` with what programs print, `overhear` with what terminals answer."""

    def type_text(self, text: str, stream: str | None) -> None:
        """Type text on a stream, by default the terminal of the run."""

    def start_all(self) -> None:
        """Start every stored program, as RUN ALL does."""

    def failure(self, program: int) -> Failure:
        """Say what ended a program with an error, and in which line."""

    def set_input(self, bit: int, on: bool) -> None:
        """Switch an input; one that the machine drives is forced until it is released."""

    def release_input(self, bit: int) -> None:
        """Let go of an input that was switched."""

    def fault(self, axis: int, kind: str, value: float) -> None:
        """Let something go wrong with an axis of the machine."""

    def mend(self, axis: int, kind: str | None) -> None:
        """End one kind of fault of an axis, or all."""

    def set_analog(self, parameter: int, value: float) -> None:
        """Bring a value to the analog input a parameter shows."""

    def drag(self, axis: int, by_u: float) -> None:
        """Move the load of an axis by hand, at once."""

    def axis_reports(self) -> Sequence[AxisReport]:
        """Position and extremes of every axis."""

    def record(self, every_tk: int, *, keep_peaks: bool, watched: Sequence[Watched] = ()) -> None:
        """Record once in `every_tk` ticks from now on, with the peaks between if wanted."""

    def curves(self, title: str) -> "Curves":
        """Give what was recorded."""


class MachineWorld:
    """The world of a scenario made of a machine."""

    def __init__(self, machine: Machine) -> None:
        self._machine = machine
        self._begin_tk = machine.tick
        self.set_input = machine.set_input
        self.release_input = machine.release_input
        self.fault = machine.fault
        self.mend = machine.mend
        self.set_analog = machine.set_analog
        self.type_text = machine.type_text
        self.drag = machine.drag

    @property
    def tick(self) -> int:
        """Servo periods since the start of the run."""
        return self._machine.tick - self._begin_tk

    def read(self, parameter: int) -> float:
        """Read one parameter; one that does not exist (yet) is not a number."""
        try:
            return self._machine.memory.read(parameter)
        except CardError:
            return nan

    def bit(self, number: int) -> bool:
        """Read one flag."""
        return self._machine.memory.bit(number)

    def position_u(self, axis: int) -> float:
        """Read the actual position of an axis in units."""
        return card_view.actual_u(self._machine.memory, axis)

    def commanded_u(self, axis: int) -> float:
        """Read the commanded position of an axis in units."""
        return card_view.commanded_u(self._machine.memory, axis)

    def program_state(self, program: int) -> State:
        """Say what a program is doing."""
        return card_view.program_state(self._machine.memory, program)
