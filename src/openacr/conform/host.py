"""A card that others use, over TCP or a serial line: lines are typed, nothing else is done."""

from __future__ import annotations

import operator
import re
from collections.abc import Callable

from openacr.client import Card
from openacr.client.errors import GarbledError
from openacr.client.links import Link
from openacr.client.program_states import ROWS, program_states
from openacr.client.standstill import KNOWN, MOVES
from openacr.conform.form import NUMBER, DifferenceError
from openacr.conform.moving import JOG_ACTIVE, of_axis
from openacr.conform.stage import PROMPT
from openacr.conform.targets import CONSOLE
from openacr.controller import Controller
from openacr.errors import UserError
from openacr.map.words import af1, mf1

PERIOD_S = 0.001  # of the clock by which answers are awaited; the card's own is not asked for
QUIET_S = 0.05  # after a prompt: one in the middle of a text is followed by more at once
ALIGN_S = 5.0
KILL = "BIT8467"  # all motion of axis 0
RELATIONS: dict[str, Callable[[float, float], bool]] = {
    "=": operator.eq, "<>": operator.ne, "<": operator.lt, ">": operator.gt,
    "<=": operator.le, ">=": operator.ge,
}  # fmt: skip
_CONDITION = re.compile(rf"((?:P|BIT) ?\d+) ?(<>|<=|>=|=|<|>) ?({NUMBER})")
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
        """Ask again and again until a condition holds; DifferenceError if it does not in time."""
        found = _CONDITION.fullmatch(condition)
        if found is None:
            raise UserError(f"wait until {condition}: expected P or BIT, a relation and a number")
        last_s = self._link.now_s() + limit_s
        while not RELATIONS[found[2]](value := self.ask(found[1]), float(found[3])):
            if self._link.now_s() > last_s:
                wanted = f"{condition} within {limit_s:g} s"
                raise DifferenceError(wanted, f"{found[1]} = {value:g}")

    def ask(self, expression: str) -> float:
        """The value of an expression; GarbledError for any other answer."""
        kept, self._waiting = self._waiting, bytearray()
        answer = self.type(f"?{expression}")
        self._waiting = kept
        try:
            return float(answer)
        except ValueError:
            raise GarbledError(self._link.name, expression, answer.encode("latin-1")) from None

    def type(self, line: str) -> str:
        """Type a line; its answer, without echo and prompt. GarbledError where no prompt comes."""
        self.send(CONSOLE, f"{line}\r".encode("latin-1"))
        last_s = self._link.now_s() + ALIGN_S
        while not self.is_answered(CONSOLE):
            if self._link.now_s() > last_s:
                raise GarbledError(self._link.name, line, bytes(self._heard))
        heard = self.heard(CONSOLE).decode("latin-1").replace("\r\n", "\n")
        return PROMPT.sub("", heard.removeprefix(f"{line}\n")).strip()

    def stop(self, axis: int) -> None:
        """Kill all motion of an axis, wait for its rest, and take the request back."""
        kill, active = (of_axis(name, axis).removeprefix("BIT") for name in (KILL, JOG_ACTIVE))
        self._link.write(f"\x1b\rSET {kill}\r".encode())
        self.align()
        self.until(f"BIT{active} = 0", ALIGN_S)
        self.type(f"CLR {kill}")

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
