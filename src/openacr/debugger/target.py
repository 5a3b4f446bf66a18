"""What is debugged, as the adapter sees it: programs of a card, or a part program on one.

A target has owners of lines, counted from 0: the programs and PLCs of a card, or the part program.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass
from typing import Protocol

from openacr.client.program_variables import Value
from openacr.debugger.breakpoints import DataBreakpoint, Fault, LineBreakpoint
from openacr.debugger.stops import Stop
from openacr.timeline import Moment, Timeline

Place = tuple[int, int]  # an owner of lines and a line
NO_STATEMENT = "nothing is executed here"  # why there is no stop


@dataclass(frozen=True, slots=True)
class Frame:
    """A line as a client shows it: of a file, or of a listing that the target gives."""

    name: str
    line: int
    path: str = ""
    listing: int = 0  # of `Target.listing`, which `path` then names; 0: a file


class Course(Protocol):
    """How what is debugged takes its course: it runs, stops, steps and goes back."""

    @property
    def period_s(self) -> float:
        """What `run` counts in [s]."""

    @property
    def is_live(self) -> bool:
        """Whether it runs on while the debugger stands: values are read as it runs."""

    @property
    def timeline(self) -> Timeline:
        """The history of the card; UserError where there is none."""

    def listen(self, show: Callable[[str], None]) -> None:
        """Show what programs print."""

    # what stops it

    def set_lines(self, breakpoints: list[LineBreakpoint]) -> None:
        """Stop before these lines, and no others."""

    def set_data(self, breakpoints: list[DataBreakpoint]) -> None:
        """Stop at these changes, and no others; UserError for what cannot be watched."""

    def set_faults(self, faults: frozenset[Fault]) -> None:
        """Stop at these faults, and no others."""

    # running

    def entry(self) -> Stop:
        """Begin; the stop at the first moment."""

    def paused(self, owner: int) -> Stop | None:
        """The stop of a pause; None if `run` reports it later."""

    def resume(self, owner: int) -> None:
        """Let an owner of lines go on."""

    def run(self, ticks: int) -> Stop | None:
        """Let time pass; why it has stopped before its end, or None."""

    def begin_step(self, owner: int, *, into: bool = False, out: bool = False) -> None:
        """Let `run` end before the next line, over routines unless `into`, or after its own."""

    def tick(self) -> Stop:
        """One servo interrupt."""

    def tick_back(self) -> Stop:
        """One servo interrupt back."""

    def step_back(self, owner: int) -> Stop:
        """Go back to the line that was executed before."""

    def run_back(self) -> Stop:
        """Go back to the last stop before the present."""

    def seek(self, moment: Moment) -> Stop:
        """Go to a moment of the present branch."""


class Target(Protocol):
    """What is debugged: what is seen of it, where it can stop, and its course."""

    @property
    def course(self) -> Course:
        """How it runs and stops."""

    @property
    def capabilities(self) -> Mapping[str, object]:
        """Where it differs from what the debugger can do with a virtual card."""

    def close(self) -> None:
        """End it; nothing that it has started moves afterwards."""

    # what is seen

    def owners(self) -> list[tuple[int, str]]:
        """The owners of lines, with their names."""

    def frames(self, owner: int) -> list[Frame]:
        """The line that is executed next, then those that have called its routine."""

    def listing(self, number: int) -> str:
        """The text of a listing; UserError if there is none."""

    def scopes(self, owner: int, depth: int) -> Iterable[tuple[str, Iterable[Value]]]:
        """The groups of values at a frame."""

    def answer(self, owner: int, expression: str) -> str:
        """The value of an expression; UserError if it has none."""

    def assign(self, owner: int, target: str, value: str) -> None:
        """Change a value; UserError if it cannot be changed."""

    def typed(self, owner: int, line: str) -> str:
        """The answer to a line that is typed in the console."""

    def heard(self) -> str:
        """What was answered since to the lines that were typed."""

    # where it can stop

    def places_of(self, path: str, listing: int, lines: Collection[int]) -> dict[int, Place]:
        """Which of these lines of a file or listing are executed, by their numbers there."""

    def why_no_stop(self, place: Place) -> str:
        """Why it cannot stop before a line; empty if it can."""

    def require_watchable(self, name: str) -> None:
        """UserError unless changes of a value can be watched."""

    def steps_lines(self, owner: int) -> bool:
        """Whether an owner steps line by line; otherwise by servo interrupts alone."""
