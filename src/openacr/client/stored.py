"""Programs and PLCs that a card holds: their room, their lines with numbers, a new text."""

import re
from collections.abc import Sequence
from hashlib import blake2b
from typing import NamedTuple

from msgspec import Struct

from openacr.client.effects import Op
from openacr.client.errors import (
    ChangedError,
    ClientError,
    DownloadError,
    RefusedError,
    VerificationError,
)
from openacr.client.listing import HIDDEN_STEP, is_free_form, plain
from openacr.client.requests import SYS, Level
from openacr.client.talk import Talk
from openacr.client.transfer import ENDS_TEXT, Report, download, upload
from openacr.errors import UserError

_ROOM = re.compile(r"DIM (PROG|PLC)(\d+)\((\d+)\)")
_ALIAS = re.compile(r"#DEFINE\s+(\S+)\s+(.+)")
_NUMBERED = re.compile(r"\s*(\d+)\s(.*)", re.DOTALL)


class Room(NamedTuple):
    """Memory of a program or PLC: what was given to it by DIM, and what is free [bytes]."""

    total: int
    free: int


class ListedLine(Struct, frozen=True):
    """A line of a listing under its number, which the card may not print."""

    number: int
    text: str


def rooms(talk: Talk) -> Op[dict[Level, Room]]:
    """The memory of every program and PLC that has some."""
    home = talk.level
    found: dict[Level, Room] = {}
    for line in (yield from talk.query("DIM", at=SYS)):
        if match := _ROOM.fullmatch(line.strip()):
            level = Level(match[1], int(match[2]))
            answer = yield from talk.query("MEM", at=level)
            found[level] = Room(int(match[3]), int(answer[-1]) if answer else 0)
    yield from talk.go(home)
    return found


def listing(talk: Talk, level: Level) -> Op[list[ListedLine]]:
    """The lines of a program or PLC as LIST shows them, each with the number it is stored under."""
    home = talk.level
    listed = yield from talk.query("LIST", at=level)
    yield from talk.go(home)
    return numbered(plain(listed))


def numbered(listed: Sequence[str]) -> list[ListedLine]:
    """Lines with their numbers; those of free-form text are stored ten apart, from 10 on."""
    if listed and is_free_form(listed[0]):
        return [ListedLine(HIDDEN_STEP * n, text) for n, text in enumerate(listed, 1)]
    found = filter(None, map(_NUMBERED.fullmatch, listed))
    return [ListedLine(int(match[1]), match[2].rstrip()) for match in found]


def version_of(lines: Sequence[ListedLine]) -> str:
    """A mark of what a card lists: another one when any line or number is another."""
    listed = "".join(f"{line.number} {line.text.rstrip()}\n" for line in lines)
    return blake2b(listed.encode(), digest_size=8).hexdigest()


def replace(talk: Talk, level: Level, text: str, version: str = "") -> Op[Report]:
    """Store another text; if the card refuses it, the one before is stored again.

    The text is the program alone, either from PROGRAM to ENDP or in numbered lines: a line that
    would be carried out instead of stored is a UserError. DownloadError says what was refused.
    With the `version` of the listing that was edited: ChangedError if the card lists another text.
    """
    require_program(text)
    if version and version_of((yield from listing(talk, level))) != version:
        raise ChangedError(f"{level} was changed on the card since it was read")
    before = yield from upload(talk, level)
    try:
        if not is_free_form(text):
            yield from talk.order("NEW", at=level)  # PROGRAM erases by itself
        return (yield from download(talk, text, to=level))
    except (DownloadError, VerificationError) as refused:
        hint = yield from _restore(talk, level, before)
        raise DownloadError(refused.text, line=refused.line, hint=hint) from None


def _restore(talk: Talk, level: Level, text: str) -> Op[str]:
    """Store the former text again; what became of it."""
    try:
        if not text:
            yield from talk.order("NEW", at=level)
            return f"{level} is empty, as before"
        yield from download(talk, text, to=level, is_verified=False)
    except ClientError:
        return f"{level} is incomplete now: its former text could not be stored again"
    return f"{level} has its former text"


def require_program(text: str) -> None:
    """Refuse a text with lines that a card would carry out instead of storing them."""
    lines = [(n, line.strip()) for n, line in enumerate(text.splitlines(), 1) if line.strip()]
    if not lines:
        raise UserError("the text is empty: CLEAR erases a program")
    if is_free_form(lines[0][1]):
        inside, (last, end) = lines[1:-1], lines[-1]
        if not re.fullmatch(r"ENDP", end, re.IGNORECASE):
            raise UserError(f"line {last}: a text that begins with PROGRAM ends with ENDP")
        for n, line in inside:
            if ENDS_TEXT.match(line):
                raise UserError(f"line {n}: {line.split()[0]} would end the program")
        return
    for n, line in lines:
        if not _NUMBERED.fullmatch(line):
            raise UserError(
                f"line {n}: every line has a number, or the text stands between PROGRAM and ENDP"
            )


def clear(talk: Talk, level: Level) -> Op[None]:
    """Erase the stored lines of a program or PLC; its memory stays."""
    home = talk.level
    yield from talk.order("NEW", at=level)
    yield from talk.go(home)


def aliases(talk: Talk) -> Op[dict[str, str]]:
    """What the names of #DEFINE stand for, of a card without memory for them nothing."""
    try:
        defined = yield from talk.query("DEF", at=SYS)
    except RefusedError:
        return {}
    return {each[1]: each[2].strip() for line in defined if (each := _ALIAS.match(line))}
