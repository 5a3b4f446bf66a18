"""A case while it runs: the dialogue with its card, what is pending, how long things took."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from openacr.conform.form import DifferenceError
from openacr.conform.targets import CONSOLE, Target, VirtualCard
from openacr.errors import UserError
from openacr.lang.characters import as_typed, shown

if TYPE_CHECKING:
    from openacr.conform.mill import Mill

PATIENCE_S = 60.0  # of the card, for the answer to a line
REPLY_S = 1.0  # for the bytes of a reply
SILENCE_TK = 20  # in which a card that must send nothing is listened to
PROMPT = re.compile(r"(?:SYS|P\d\d|PLC\d)>\Z")


@dataclass(slots=True)
class Stage:
    """The card of a case, and the terminal the case types on."""

    card: Target
    channel: str = CONSOLE
    took_tk: int = 0  # by the latest line or wait
    pending: dict[str, bytes] = field(default_factory=dict)  # heard and not yet compared
    prompts: dict[str, str] = field(default_factory=dict)
    notes: dict[str, float] = field(default_factory=dict)  # values that a case refers to
    _mill: Mill | None = None

    @property
    def mill(self) -> Mill:
        """The front end on the card, from its first use."""
        if self._mill is None:
            if not isinstance(self.card, VirtualCard):
                raise UserError("the front end runs on a virtual card alone")
            from openacr.conform.mill import (
                Mill,  # half of all imports, for the cases of parts alone
            )

            self._mill = Mill(self.card)
        return self._mill

    def close(self) -> None:
        """End what the case has begun beside its card."""
        if self._mill is not None:
            self._mill.close()

    @property
    def prompt(self) -> str:
        """The prompt of the terminal; the one of the system level after power-up."""
        return self.prompts.get(self.channel, "SYS>")

    def take(self) -> str:
        """All that the terminal has shown since it was last looked at."""
        return _text(self._heard())

    def _heard(self) -> bytes:
        return self.pending.pop(self.channel, b"") + self.card.heard(self.channel)

    def expect_silence(self) -> None:
        """DifferenceError if the terminal has shown what no line of the case expects."""
        if lines := self.answer(self.take()):
            raise DifferenceError("(nothing before this line)", shown("\n".join(lines)))

    def expect_no_alarm(self) -> None:
        """DifferenceError if the front end has an alarm that the case does not look at."""
        if self._mill is not None and not self._mill.are_alarms_expected:
            if alarms := self._mill.alarms():
                raise DifferenceError("(no alarm)", "\n".join(alarms))

    def type(self, text: str) -> str:
        """Type a line; what the terminal shows at once, without the echo."""
        self._send(text)
        return self.take().removeprefix(f"{text}\n")

    def _send(self, text: str) -> None:
        self.expect_silence()
        self.card.send(self.channel, as_typed(text) + b"\r")

    def say(self, text: str) -> list[str]:
        """Type a line; the lines of its answer, with echo and prompt taken away.

        A last line without an end has the prompt after it, as on the terminal.
        """
        begun_tk = self.card.tick
        self._send(text)
        data = self._heard()
        last_tk = begun_tk + round(PATIENCE_S / self.card.period_s)
        while not (is_answered := self.card.is_answered(self.channel)):
            if self.card.tick >= last_tk:
                break
            self.card.advance(1)
            data += self._heard()
        data += self._heard()  # over a wire an echo, even a line end, may come in pieces
        heard = _text(data).removeprefix(f"{text}\n")
        if not is_answered:
            raise DifferenceError(f"an answer within {PATIENCE_S:g} s", heard or "(nothing)")
        self.took_tk = self.card.tick - begun_tk
        return self.answer(heard)

    def answer(self, heard: str) -> list[str]:
        """The lines of an answer; its prompt is kept in `prompt`."""
        prompt = PROMPT.search(heard)
        if prompt:
            self.prompts[self.channel] = prompt[0]
            heard = heard[: prompt.start()]
        *lines, last = heard.split("\n")
        return [*lines, last + (prompt[0] if prompt else "")] if last else lines

    def set_up(self, text: str) -> None:
        """Type a line that must not be answered."""
        if answer := self.say(text):
            raise DifferenceError(f"{text}: no message", "\n".join(answer))

    def value(self, text: str) -> float | str:
        """The value of an expression as the card computes it: a number, or a text.

        `<NAME>` in it is a value that was noted.
        """
        for name, value in self.notes.items():
            text = text.replace(f"<{name}>", f"({value!r})")
        number = self.card.number(text)
        if number is not None:
            return number
        answer = self.say(f"?{text}")
        if len(answer) != 1:
            raise DifferenceError(f"one value of {text}", "\n".join(answer) or "(nothing)")
        try:
            return float(answer[0])
        except ValueError:
            return answer[0]

    def reply(self, count: int) -> bytes:
        """The next `count` bytes the terminal receives, or fewer if no more arrive in time.

        For a count of 0, that nothing arrives for a while; else all that did.
        """
        last_tk = self.card.tick + (round(REPLY_S / self.card.period_s) if count else SILENCE_TK)
        heard = self._heard()
        while len(heard) < (count or 1) and self.card.tick < last_tk:
            self.card.advance(1)
            heard += self.card.heard(self.channel)
        if count and heard[count:]:
            self.pending[self.channel] = heard[count:]
        return heard[: count or None]


def _text(data: bytes) -> str:
    return data.decode("latin-1").replace("\r\n", "\n")
