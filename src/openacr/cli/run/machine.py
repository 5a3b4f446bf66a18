"""What a run needs of a card besides what a scenario needs of it."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Protocol

from openacr.cli.results import AxisReport, Event, Watched
from openacr.scenario.played import Failure, Played

if TYPE_CHECKING:
    from openacr.cli.plots import Curves


class Machine(Played, Protocol):
    """A card with its project loaded, at rest between two ticks."""

    @property
    def time_s(self) -> float:
        """Simulated seconds lived so far."""

    def digest(self) -> str:
        """Fingerprint of the whole state."""

    def closed_switches(self) -> dict[int, list[int]]:
        """Inputs of normally closed limit switches that are enabled, by axis."""

    def events(self) -> Sequence[Event]:
        """What happened to the machine since the last call."""

    def start_all(self) -> None:
        """Start every stored program, as RUN ALL does."""

    def failure(self, program: int) -> Failure:
        """Say what ended a program with an error, and in which line."""

    def axis_reports(self) -> Sequence[AxisReport]:
        """Position and extremes of every axis."""

    def record(self, every_tk: int, *, keep_peaks: bool, watched: Sequence[Watched] = ()) -> None:
        """Record once in `every_tk` ticks from now on, with the peaks between if wanted."""

    def curves(self, title: str) -> "Curves":
        """Give what was recorded."""
