"""Aries drives on serial lines of the computer, for the Drive Talk of the card.

A line of text goes out, what comes back is the answer as soon as the line is quiet. A drive's echo
and prompt are left out.

| seen | what the card shows |
|---|---|
| no byte within a second; the port is gone or cannot be opened; wrong settings | no answer |
| bytes that are no text, or more of them than an answer has | two answers |
| an address for one of several drives on one line, which all would take | two answers |

No answer is Drive Timeout, and Drive Lost if the drive had answered before; two are Address Error.
"""

import logging
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Protocol

from openacr.errors import UserError
from openacr.map.rows import drive_talk_lines
from openacr.plant.bus.aries_port import only_reads
from openacr.plant.bus.rs485 import CHARACTER_BITS
from openacr.plant.describe.network_schema import PORTS, TalkingDrive

log = logging.getLogger(__name__)

SILENCE_S = 1.0  # a drive may take to begin an answer
QUIET_S = 0.05  # after a whole line: an adapter hands bytes on every 16 ms
PARTIAL_S = 0.25  # after a part of one
LONGEST = drive_talk_lines.ANSWER_SIZE
PROMPTS = "> "
NONE: list[str] = []
GARBLED = ["", ""]


class SerialLine(Protocol):
    """A serial port of the computer: 8 data bits, no parity, one stop bit. No call waits."""

    def open(self, baud: int) -> None:
        """Open it with this speed, or set the speed; UserError if it cannot be opened."""

    def send(self, data: bytes) -> None:
        """Forget what has arrived and send; UserError if the port is gone."""

    def take(self) -> bytes:
        """What has arrived since the last call; UserError if the port is gone."""

    def now_s(self) -> float:
        """Seconds of a clock that never goes back."""


@dataclass(slots=True)
class _Line:
    """A serial line and the exchange on it."""

    port: SerialLine
    axes: list[int] = field(default_factory=list)
    sent: str = ""
    heard: bytes = b""
    since_s: float = 0.0  # of the last byte
    result: list[str] | None = None
    is_dead: bool = False  # nothing was sent: the drive does not answer
    said: str = ""


class RealDrives:
    """The drives of a machine that have a `serial` port; only read before `allow`."""

    def __init__(
        self, tables: Iterable[TalkingDrive], port_of: Callable[[str], SerialLine]
    ) -> None:
        self._lines: dict[str, _Line] = {}
        self._drives: dict[int, TalkingDrive] = {}
        self._may_write = False
        for table in tables:
            if table.serial is not None:
                if table.serial not in self._lines:
                    self._lines[table.serial] = _Line(port_of(table.serial))
                self._lines[table.serial].axes.append(table.axis)
                self._drives[table.axis] = table

    def allow(self) -> None:
        """Let everything be sent; before it only what reads."""
        self._may_write = True

    def begin(self, port: int, axis: int, text: str, *, baud: int, bits: int, alone: bool) -> bool:
        """Send a line of text; False if the drive of the axis is modelled."""
        table = self._drives.get(axis)
        if table is None:
            return False
        line = self._lines[table.serial or ""]
        line.sent, line.heard, line.result = text, b"", None
        line.since_s = line.port.now_s()
        line.is_dead = True
        if PORTS[table.port] != port or bits != CHARACTER_BITS:
            return True
        if alone and len(line.axes) > 1:
            others = len(line.axes)
            self._say(line, f"{table.serial} leads to {others} drives, which would all take the"
                            f" address of axis {axis}: give each its own by itself")  # fmt: skip
            line.result = GARBLED
        elif not self._may_write and not only_reads(text):
            self._say(line, f"{text} was not sent to the drive of axis {axis}: it is only read"
                            " (serve --real)")  # fmt: skip
        else:
            try:
                line.port.open(baud)
                line.port.send(f"{text}\r".encode("latin-1", "replace"))
            except UserError as failure:
                self._say(line, str(failure))
            else:
                line.is_dead = False
        return True

    def answers(self, axis: int) -> list[str] | None:
        """What drives have answered; None while an answer is waited for."""
        line = self._lines[self._drives[axis].serial or ""]
        if line.result is None:
            line.result = self._look(line)
        return line.result

    def _look(self, line: _Line) -> list[str] | None:
        now_s = line.port.now_s()
        if not line.is_dead:
            try:
                fresh = line.port.take()
            except UserError as failure:
                self._say(line, str(failure))
                line.is_dead, line.heard = True, b""
            else:
                if fresh:
                    line.heard, line.since_s = line.heard + fresh, now_s
        quiet_s = now_s - line.since_s
        answer = _without_echo(line.heard.decode("latin-1"), line.sent)
        if len(answer) > LONGEST:
            return GARBLED
        if not answer:
            return NONE if quiet_s > SILENCE_S else None
        is_line = answer.endswith(("\r", "\n")) and bool(answer.strip())
        if quiet_s <= (QUIET_S if is_line else PARTIAL_S):
            return None
        line.said = ""
        return [_lines_of(answer)] if _is_text(answer) else GARBLED

    def _say(self, line: _Line, text: str) -> None:
        """Say what is wrong with a line, once until it answers."""
        if text != line.said:
            log.warning("Drive Talk: %s", text)
        line.said = text


def _without_echo(heard: str, sent: str) -> str:
    """What a drive has sent by itself; a line end if its echo was all so far."""
    text = heard.lstrip(PROMPTS)
    if text.startswith(sent):
        after = text.removeprefix(sent)
        rest = after.removeprefix("\r").removeprefix("\n")
        return rest if rest.strip(PROMPTS) else after.strip(PROMPTS)
    return "" if sent.startswith(text) else text


def _is_text(answer: str) -> bool:
    return all(" " <= each <= "~" or each in "\r\n\t" for each in answer)


def _lines_of(answer: str) -> str:
    """The lines of an answer, as a drive ends them, without its prompt."""
    lines = answer.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    shown = [line.lstrip(PROMPTS) for line in lines]
    while shown and not shown[-1]:
        shown.pop()
    return "".join(f"{line}\r\n" for line in shown or [""])
