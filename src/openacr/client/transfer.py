"""Transfer programs to and from a card: line by line, verified against its listing."""

import re
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TypeAlias

from msgspec import Struct

from openacr.basic.language.loader import FileLine, file_lines
from openacr.basic.memory.program_store import opens_capture
from openacr.channels import EchoMode
from openacr.client.effects import Op
from openacr.client.errors import ClientError, DownloadError, RefusedError, VerificationError
from openacr.client.listing import Stored, is_free_form, is_numbered, plain
from openacr.client.requests import SYS, Level, Line
from openacr.client.talk import Talk, checked
from openacr.errors import UserError

Progress: TypeAlias = Callable[[int, int], None]

ENDS_TEXT = re.compile(
    r"[\s:]*(?:ENDP(?![A-Za-z])|SYS(?![A-Za-z])|(?:PROG|PLC)\s*\d)", re.IGNORECASE
)
_IS_NUMBERED = re.compile(r"\s*\d")
_UNSENDABLE = str.maketrans("", "", "\x0c\x1a\x1b")  # page and file ends, captured keys


class Remark(Struct, frozen=True):
    """The card's output for a line it accepted: a report, not a known error."""

    line: int
    text: str


@dataclass(slots=True)
class Report:
    """The result of a download."""

    sent: int = 0
    entered: dict[Level, Stored] = field(default_factory=dict)
    remarks: list[Remark] = field(default_factory=list)


def download(
    talk: Talk,
    text: str,
    *,
    path: str = "",
    to: Level | None = None,
    progress: Progress | None = None,
    is_verified: bool = True,
) -> Op[Report]:
    """Send a controller file; DownloadError at the first line the card refuses."""
    before = talk.options.echo
    talk.set_echo(EchoMode.CHARACTERS)  # every line needs its prompt, including stored ones
    try:
        yield from talk.go(to or SYS)
        sender = _Sender(talk, path)
        lines = _lines(text)
        for number, line in enumerate(lines, start=1):
            yield from sender.send(line)
            if progress is not None:
                progress(number, len(lines))
        yield from sender.end()
        if is_verified:
            yield from _verify(talk, sender.report, path)
        return sender.report
    finally:
        talk.set_echo(before)


def _lines(text: str) -> list[FileLine]:
    """The lines to send for a file: published listings need some tolerance, our own none."""
    cleaned = text.translate(_UNSENDABLE)
    if is_numbered(cleaned):
        numbered = enumerate(cleaned.splitlines(), start=1)
        return [FileLine(number, line.strip()) for number, line in numbered if line.strip()]
    return file_lines(cleaned)


@dataclass(slots=True)
class _Sender:
    """Sends the lines of one file and keeps track of what they store."""

    talk: Talk
    path: str
    report: Report = field(default_factory=Report)
    _captured: Stored | None = None
    _last: int = 0

    def send(self, line: FileLine) -> Op[None]:
        """Send a line; DownloadError if the card refuses it."""
        try:
            answer = yield from self.talk.exchange(Line(line.text))
            output = checked(line.text, answer.lines)
            if self._captured is not None and output:
                raise RefusedError(line.text, output[-1])
        except RefusedError as refused:
            raise (yield from self._failed(line, refused.text, refused.hint)) from None
        except UserError as unsendable:
            raise (yield from self._failed(line, str(unsendable))) from None
        except (ClientError, KeyboardInterrupt):
            yield from self._erase()
            raise
        self.report.sent += 1
        self.report.remarks += [Remark(line.number, text) for text in output]
        self._note(line)

    def _note(self, line: FileLine) -> None:
        """Record what the card has stored."""
        self._last = line.number
        if self._captured is not None:
            if ENDS_TEXT.match(line.text):
                is_endp = line.text.lstrip(" \t:").upper().startswith("ENDP")
                self._captured.add(line.text if is_endp else "ENDP", line.number)
                self._captured = None
            else:
                self._captured.add(line.text, line.number)
        elif opens_capture(line.text) is not None:
            self._captured = self.report.entered[self.talk.level] = Stored(is_whole=True)
            self._captured.add(line.text, line.number)
        elif _IS_NUMBERED.match(line.text):
            stored = self.report.entered.setdefault(self.talk.level, Stored())
            stored.add(line.text, line.number)

    def end(self) -> Op[None]:
        """End the entry: the end of the file ends a program as ENDP does."""
        if self._captured is not None:
            yield from self.send(FileLine(self._last, "ENDP"))

    def _failed(self, line: FileLine, text: str, hint: str = "") -> Op[DownloadError]:
        erased = yield from self._erase()
        hint = "; ".join(filter(None, (hint, erased)))
        return DownloadError(text, path=self.path, line=line.number, hint=hint)

    def _erase(self) -> Op[str]:
        """Erase an incomplete program, which could be run by mistake; returns a note of it."""
        if self._captured is None:
            return ""
        self._captured = None
        level = self.talk.level
        try:
            yield from self.talk.order("SYS")  # ends the entry, also on a new connection
            yield from self.talk.order("NEW", at=level)
        except ClientError:
            return f"{level} is incomplete now"
        return f"{level} was erased: it was incomplete"


def _verify(talk: Talk, report: Report, path: str) -> Op[None]:
    """Compare the listing of the card with what was sent; VerificationError."""
    home = talk.level
    for level, stored in report.entered.items():
        try:
            listed = yield from talk.query("LIST", at=level)
        except RefusedError as refused:
            raise VerificationError(f"{level}: {refused.text}", path=path) from None
        wrong = stored.difference(listed)
        if wrong is not None:
            raise VerificationError(f"{level}: {wrong[1]}", path=path, line=wrong[0])
    yield from talk.go(home)


def upload(talk: Talk, level: Level) -> Op[str]:
    """Read a program or PLC as a file that can be downloaded again; empty if none is stored."""
    home = talk.level
    listed = plain((yield from talk.query("LIST", at=level)))
    yield from talk.go(home)
    if not listed:
        return ""
    head = [] if is_free_form(listed[0]) else ["NEW"]  # numbered lines would only be added
    return "".join(f"{line}\n" for line in [*head, *listed])
