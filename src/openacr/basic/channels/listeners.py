"""Who follows which program: PRINT output, trace and run-time errors go there."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Protocol

from openacr.basic.channels.session import Session
from openacr.basic.vm.code import BEGINS_LINE
from openacr.basic.vm.run import LINE_END


class Follower(Protocol):
    """Hears what programs in trace mode execute, instead of the channels.

    Programs that are started while there is one also stop for it within their lines.
    """

    def reached(self, program: int, line: int, marks: int) -> None:
        """A statement is executed next; its marks are those of `basic.vm.code`."""

    def ended(self, program: int) -> None:
        """A program has ended, or an error has ended it."""

    def plc_changes(self, plc: int) -> None:
        """Other code is about to take the place of that of a PLC: RUN, or a restart."""


class Listeners:
    """Delivers the output of programs; without a listener it is lost."""

    def __init__(self, sessions: Mapping[str, Session]) -> None:
        self._sessions = sessions
        self.taps: list[Callable[[int, str], None]] = []  # hear everything, beside the channels
        self.follower: Follower | None = None  # hears of lines in trace mode

    def of(self, program: int) -> Iterator[Session]:
        """The channels that listen to a program, in their fixed order."""
        for session in self._sessions.values():
            if session.listening_to == program:
                yield session

    def print(self, program: int, text: str) -> None:
        """Send text as it is."""
        for tap in self.taps:
            tap(program, text)
        for session in self.of(program):
            session.write(text)

    def error(self, program: int, line: int, message: str) -> None:
        """Report the run-time error that has ended a program."""
        self.print(program, f"Error in PROG{program} line {line}: {message}{LINE_END}")

    def trace(self, program: int, line: int, marks: int) -> None:
        """TRON: the number of the line that is executed next; a follower alone hears of it."""
        if self.follower is not None:
            self.follower.reached(program, line, marks)
        elif marks & BEGINS_LINE:
            self.print(program, f"[{line}]")

    def plc_changes(self, plc: int) -> None:
        """RUN of a PLC, or a restart: a follower takes what the code before has noted."""
        if self.follower is not None:
            self.follower.plc_changes(plc)

    def set_line_end(self, program: int, shown: bool) -> None:
        """Whether the CR of a typed line is echoed; `INPUT;` keeps the cursor in its line."""
        for session in self.of(program):
            session.echo_line_end = shown

    def ended(self, program: int) -> None:
        """A program has ended: channels that typed LRUN get their prompt back."""
        if self.follower is not None:
            self.follower.ended(program)
        for session in self.of(program):
            if session.until_end:
                session.program_ended()
