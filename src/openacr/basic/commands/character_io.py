"""Character I/O: PRINT, INPUT, OPEN, CLOSE, TALK TO, and the keys of a device."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from msgspec import Struct

from openacr.basic.language.grammar import (
    Command,
    Either,
    Form,
    Int,
    Mark,
    Object,
    ObjectRef,
    Str,
)
from openacr.basic.language.nodes import (
    Expr,
    Statement,
    is_text,
)
from openacr.basic.language.number_format import UsingFormat
from openacr.basic.language.registry import ANY, IMMEDIATE, PROG, command, functions
from openacr.basic.vm.printed import printed
from openacr.basic.vm.run import LINE_END, Run, Wait, WaitKind
from openacr.errors import CardError
from openacr.lang.lexer import TokenKind
from openacr.messages import INVALID_DEVICE, SYNTAX_ERROR, UNDEFINED_SYMBOL

if TYPE_CHECKING:
    from openacr.basic.language.parser import Parser

GROUP = "Character I/O"
TAB = "\t"
DEVICES = 3

_PORT = re.compile(r"\s*([A-Za-z]+\d?)\s*:?\s*(.*)", re.DOTALL)
_BAUD_RATES = frozenset((300, 600, 1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200))
_SERIAL_FIELDS = re.compile(r"(\d*)\s*(?:,\s*([NOEnoe]?)\s*(?:,\s*([5-8]?)\s*(?:,\s*([12]?))?)?)?")


# PRINT


class Picture(Struct, frozen=True):
    """USING: the format of the next number."""

    text: Expr


PrintItem = Picture | Expr | str  # a separator is its character


class Print(Struct, frozen=True):
    """PRINT as written: the device, None for the terminal, and the items."""

    device: int | None = None
    items: tuple[PrintItem, ...] = ()


class PrintList(Form):
    """`{#d,} {USING "fmt";} {item {;|,}}...`; the handler gets the trees."""

    def starts(self, p: Parser) -> bool:
        """Whether a device, an item or a separator begins here."""
        if p.at_unknown_word:
            raise p.cursor.error(UNDEFINED_SYMBOL)
        return p.cursor.is_operator("#") or at_separator(p) or self._at_item(p)

    def parse(self, p: Parser) -> Print:
        """Read the device and as many items as there are."""
        device = None
        if p.cursor.is_operator("#"):
            device = read_device(p)
        found: list[PrintItem] = []
        while at_separator(p) or self._at_item(p):
            if at_separator(p):
                found.append(str(p.cursor.advance().value))
            elif p.cursor.accept("USING"):
                found.append(Picture(p.expressions.expression()))
                p.cursor.expect(";")
            else:
                found.append(p.expressions.expression())
        return Print(device, tuple(found))

    @staticmethod
    def _at_item(p: Parser) -> bool:
        token = p.cursor.token
        if token.kind is TokenKind.WORD:
            named = token.value in functions and not p.begins_command(token)
            called = token.value in functions and p.cursor.ahead(1).value == "("
            return p.expressions.at_variable or p.cursor.is_word("USING", "NOT") or named or called
        return token.kind in (TokenKind.NUMBER, TokenKind.STRING) or token.value in ("(", "-", "+")


def at_separator(p: Parser) -> bool:
    """Whether `;` or `,` stands here."""
    return p.cursor.is_operator(";") or p.cursor.is_operator(",")


def read_device(p: Parser) -> int:
    """`#d` with the separator after it."""
    p.cursor.expect("#")
    token = p.cursor.advance()
    if token.kind is not TokenKind.NUMBER or token.value not in range(DEVICES + 1):
        raise p.cursor.error(SYNTAX_ERROR)
    if at_separator(p):
        p.cursor.advance()
    return int(token.value)


class Report(Command):
    """A command after PRINT, whose report is printed; functions come first."""

    def starts(self, p: Parser) -> bool:
        """Whether a command word stands here, and no function is called."""
        calls = p.cursor.token.value in functions and p.cursor.ahead(1).value == "("
        return super().starts(p) and not calls

    def parse(self, p: Parser) -> Statement:
        """Read the command; one of the VM or of a move has nothing to report."""
        read = super().parse(p)
        if read.command.emit is not None or read.command.move:
            raise p.cursor.error(SYNTAX_ERROR)
        return read


@command(
    "PRINT",
    "?",
    group=GROUP,
    levels=ANY,
    grammar=(Either(Report(), PrintList("items"), optional=True),),
    ref="PG Character I/O",
)
def print_(run: Run, what: Statement | Print | None) -> Wait | None:
    """Send text and numbers to the terminal, or with `#d` to an open device."""
    if isinstance(what, Statement):
        return run.execute(what)
    what = what or Print()
    if what.device is None:
        run.write(print_text(run, what.items))
        return None
    key = (run.needed_program(), what.device)
    run.system.devices.check_open(key)
    run.system.devices.write(key, print_text(run, what.items))
    return None


def print_text(run: Run, items: tuple[PrintItem, ...]) -> str:
    """What PRINT sends: items in sequence, a TAB for a comma, CR LF unless a separator ends."""
    parts: list[str] = []
    picture: UsingFormat | None = None
    for item in items:
        if isinstance(item, str):
            parts.append(TAB if item == "," else "")
        elif isinstance(item, Picture):
            picture = UsingFormat.parse(run.text(item.text))
        elif is_text(item):
            parts.append(run.text(item))
        elif picture is not None:
            parts.append(picture.text(run.value(item)))
            picture = None
        else:
            parts.append(printed(run, item))
    if not items or not isinstance(items[-1], str):
        parts.append(LINE_END)
    return "".join(parts)


# OPEN, CLOSE


class Channel(Object):
    """A channel by its word: COM1, STREAM3, FIFO, DPCB."""

    def __init__(self, *, optional: bool = False) -> None:
        super().__init__("COM", "STREAM", singles=("FIFO", "DPCB"), optional=optional)


def channel_name(channel: ObjectRef) -> str:
    """The name of a channel, as the sessions have it."""
    return channel.word if channel.number < 0 else f"{channel.word}{channel.number}"


@command(
    "OPEN",
    group=GROUP,
    levels=PROG,
    grammar=(Str("device"), Mark("AS"), Mark("#"), Int("d", 1, DEVICES)),
    ref="PG Character I/O",
)
def open_(run: Run, device: str, number: int) -> None:
    """Make a channel the device `#d` of this program."""
    run.system.devices.open((run.needed_program(), number), port_name(device))


def port_name(text: str) -> str:
    """The channel a device string names; its serial settings are checked."""
    match = _PORT.fullmatch(text)
    if match is None:
        raise CardError(INVALID_DEVICE)
    name, settings = match[1].upper(), match[2].strip()
    if settings and not (name.startswith("COM") and _are_serial_settings(settings)):
        raise CardError(INVALID_DEVICE)
    return name


def _are_serial_settings(text: str) -> bool:
    match = _SERIAL_FIELDS.fullmatch(text)
    return match is not None and (not match[1] or int(match[1]) in _BAUD_RATES)


@command(
    "CLOSE",
    group=GROUP,
    levels=PROG,
    grammar=(Mark("#"), Int("d", 1, DEVICES)),
    ref="PG Character I/O",
)
def close(run: Run, number: int) -> Wait | None:
    """Give a device back once its output is sent."""
    key = (run.needed_program(), number)
    if run.system.devices.is_sending(key):
        return Wait(WaitKind.NEXT_SLICE, retry=True)
    run.system.devices.close(key)
    return None


@command(
    "TALK TO",
    group=GROUP,
    levels=ANY,
    use=IMMEDIATE,
    grammar=(Either(Str("device"), Channel()),),
    ref="PG Character I/O",
)
def talk_to(run: Run, device: str | ObjectRef) -> None:
    """Join this channel with another one in both directions until ESC."""
    name = port_name(device) if isinstance(device, str) else channel_name(device)
    other = run.system.sessions.get(name)
    if other is None or other is run.channel:
        raise CardError(INVALID_DEVICE)
    run.channel.join_channel(other)
