"""A card that others use, over TCP or a serial line: lines are typed, nothing else is done."""

from __future__ import annotations

import re

from openacr.client import Card
from openacr.client.errors import GarbledError
from openacr.client.links import Link
from openacr.client.program_states import ROWS, program_states
from openacr.client.standstill import KNOWN, MOVES
from openacr.conform.stage import PROMPT
from openacr.conform.targets import CONSOLE
from openacr.controller import Controller
from openacr.errors import UserError
from openacr.map.words import af1, mf1

PERIOD_S = 0.001  # of the clock by which answers are awaited; the card's own is not asked for
QUIET_S = 0.05  # after a prompt: one in the middle of a text is followed by more at once
ALIGN_S = 5.0
_ALIGNED = re.compile(rb"SYS>\Z")


class HostCard:
    """The connection of a host to a card; cases that only ask run on it (asking.py)."""

    period_s = PERIOD_S

    def __init__(self, link: Link) -> None:
        self._link = link
        self._begun_s = link.now_s()
        self._heard = bytearray()  # since the latest line, to find its prompt
        self._waiting = bytearray()  # heard, not taken yet

    @property
    def tick(self) -> int:
        """Milliseconds since the connection began."""
        return round((self._link.now_s() - self._begun_s) / PERIOD_S)

    def align(self) -> None:
        """Come to the system level with nothing half typed; GarbledError where no SYS> comes."""
        self._link.write(b"\x1b\rSYS\r")
        last_s = self._link.now_s() + ALIGN_S
        heard = b""
        while self._link.now_s() < last_s:
            more = self._link.read(QUIET_S)
            heard += more
            if not more and _ALIGNED.search(heard):
                self._heard.clear()
                self._waiting.clear()
                return
        raise GarbledError(self._link.name, "SYS", heard)

    def send(self, channel: str, data: bytes) -> None:
        """Type on the one terminal there is."""
        if channel != CONSOLE:
            raise UserError(f"{channel}: a host has one terminal, {CONSOLE}")
        self._heard.clear()
        self._link.write(data)

    def heard(self, channel: str) -> bytes:
        """What has arrived since the last call."""
        data, self._waiting = bytes(self._waiting), bytearray()
        return data

    def is_answered(self, channel: str) -> bool:
        """Whether a prompt has come after the line, and nothing follows it."""
        self._take(0.0)
        if not PROMPT.search(self._heard.decode("latin-1")):
            return False
        return not self._take(QUIET_S)

    def _take(self, seconds: float) -> bool:
        data = self._link.read(seconds)
        self._heard += data
        self._waiting += data
        return bool(data)

    def advance(self, ticks: int) -> None:
        """Wait, or until something arrives."""
        self._take(ticks * PERIOD_S)

    def until(self, condition: str, limit_s: float) -> None:
        """Not on a card in use."""
        raise UserError(f"wait until {condition}: only on a virtual card")

    def number(self, what: str) -> float | None:
        """Nothing is read but by lines that are typed."""
        return None

    def printed(self) -> str:
        """Programs print elsewhere."""
        return ""

    def state(self) -> str:
        """Nothing is known beside the dialogue."""
        return ""

    @property
    def world(self) -> Controller:
        """No world to change."""
        raise UserError("only a virtual card has inputs and a machine that a case can change")


def occupation(card: Card) -> str:
    """What runs or moves on a card, in words; empty at rest. PLCs run always: they do not count."""
    values = [int(each) for each in card.read_many([*ROWS, *mf1.word, *af1.word])]
    states, masters = values[: len(ROWS)], values[len(ROWS) : -len(af1.word)]
    running = [
        f"{state.level.word}{state.level.number} runs"
        for state in program_states(states)
        if state.is_running and state.level.word == "PROG"
    ]
    running += [f"master {n} has moves" for n, word in enumerate(masters) if word & MOVES]
    axes = values[-len(af1.word) :]
    running += [f"axis {n} moves" for n, word in enumerate(axes) if word & KNOWN]
    return ", ".join(running)
