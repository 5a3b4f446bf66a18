"""The operator of a machine: absent at a virtual one, at the terminal of a real one.

Lines are read beside the run. While the operator thinks about an answer the machine is looked
at as always: its emergency stop does not wait for a key.
"""

import sys
import threading
from collections.abc import Callable
from dataclasses import dataclass
from queue import Empty, Queue
from typing import TYPE_CHECKING, TextIO

import typer

from openacr.errors import UserError

if TYPE_CHECKING:
    from openacr.mill.run.runner import Runner
    from openacr.mill.session import MillSession

MOST_LINES = 100  # typed ahead; the rest stays in the terminal or pipe
NO = frozenset({"n", "no"})
YES = frozenset({"", "y", "yes"})


class Lines:
    """Lines typed at the terminal, as they arrive."""

    def __init__(self, source: TextIO | None = None) -> None:
        self._lines: Queue[str] = Queue(MOST_LINES)
        self._source = source or sys.stdin
        self._is_left = False
        threading.Thread(target=self._read, name="terminal", daemon=True).start()

    def _read(self) -> None:
        for line in self._source:
            self._lines.put(line.strip())
        self._is_left = True

    def take(self) -> str | None:
        """The next line; None while none is available."""
        try:
            return self._lines.get_nowait()
        except Empty:
            return None

    @property
    def are_over(self) -> bool:
        """Whether input has ended."""
        return self._is_left and self._lines.empty()


@dataclass(frozen=True, slots=True)
class Question:
    """A question of the machine to its operator."""

    text: str
    answer: Callable[[str], object]  # UserError for an invalid answer
    unattended: str  # the error where no terminal is connected


class Attendant:
    """Attends a machine at every step."""

    def __init__(self, source: TextIO | None = None) -> None:
        self._source = source
        self._lines: Lines | None = None
        self._asked = ""

    def __call__(self, shop: "MillSession") -> None:
        """Answer the question the machine waits on."""
        if shop.is_virtual:
            shop.carry_on()
            return
        question = _question(shop.runner)
        if question is None:
            self._asked = ""
            return
        try:
            line = self.answer(question.text, question.unattended)
            if line is not None:
                self._asked = ""  # the answer may lead to the same question again
                question.answer(line)
        except UserError as error:
            if not self.is_there:
                shop.runner.abort()
                raise
            typer.echo(f"error: {error}", err=True)

    @property
    def is_there(self) -> bool:
        """Whether input is a terminal."""
        return (self._source or sys.stdin).isatty()

    def answer(self, text: str, unattended: str) -> str | None:
        """The answer to a question, which is printed once; None while none is typed."""
        if not self.is_there or (self._lines is not None and self._lines.are_over):
            raise UserError(unattended)
        lines = self.lines
        if text != self._asked:
            while lines.take() is not None:
                pass  # typed before the question
            self._asked = text
            typer.echo(f"{text} ", nl=False, err=True)
        line = lines.take()
        if line is not None:
            self._asked = ""
        return line

    @property
    def lines(self) -> Lines:
        """The lines typed at this terminal."""
        if self._lines is None:
            self._lines = Lines(self._source)
        return self._lines


def require_yes(shop: "MillSession", terminal: Attendant, text: str, unattended: str) -> None:
    """Ask before something dangerous: only y continues; the machine is polled meanwhile."""
    while True:
        line = terminal.answer(f"{text} [y/N]", unattended)
        if line is not None:
            if line.lower() in YES - {""}:
                return
            raise UserError("not started")
        shop.step()


def _question(runner: "Runner") -> Question | None:
    """The question that the machine waits with, if it does."""
    from openacr.mill.run.lifecycle import State

    reason = runner.reason
    if runner.state is State.HOLD:
        return _yes_or_no(runner, f"{reason}: continue?", runner.start, reason)
    if runner.state is State.PAUSED and runner.alarms.bars_start:
        text = runner.alarms.active[0].text
        return _yes_or_no(runner, f"{text}: acknowledge and resume?", _resumes(runner), text)
    if (ask := runner.asking) is not None:
        return Question(
            f"{ask.text}:",
            lambda line: runner.answer(number_in(line)),
            f"no operator at a terminal to answer {ask.text!r}; use --answer",
        )
    if runner.entry_actions.changer.wants_confirmation:
        return _yes_or_no(runner, f"{reason}: done?", runner.entry_actions.changer.confirm, reason)
    return None


def _yes_or_no(runner: "Runner", text: str, yes: Callable[[], object], reason: str) -> Question:
    def answer(line: str) -> None:
        if line.lower() in NO:
            runner.abort()
        elif line.lower() in YES:
            yes()
        else:
            raise UserError(f"{line}: say y or n")

    return Question(f"{text} [Y/n]", answer, f"{reason}: no operator at a terminal to continue")


def _resumes(runner: "Runner") -> Callable[[], None]:
    def resume() -> None:
        runner.acknowledge()
        runner.resume()

    return resume


def number_in(line: str) -> float:
    """The number that was typed."""
    try:
        return float(line)
    except ValueError:
        raise UserError(f"{line}: enter a number") from None
