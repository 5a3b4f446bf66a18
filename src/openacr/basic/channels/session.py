"""One command channel: its level and modes, and what becomes of each line typed there.

Lines, keys and answers are data; bytes, echo and line editing belong to the protocol. The
rule hosts depend on: one line, the output of that line, then exactly one prompt.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, Protocol

from msgspec import Struct

from openacr.basic.channels.channel_words import ChannelWords
from openacr.basic.channels.entry import Entry, Texts, split_at_level
from openacr.basic.language.parser import Parser
from openacr.basic.language.registry import Level
from openacr.basic.language.scope import Scope
from openacr.basic.memory.program_memory import PROGRAMS
from openacr.basic.memory.program_store import StoredLine
from openacr.basic.memory.ranges import (
    DeviceNumber,
    EchoBits,
    LineNumber,
    ModeBits,
    OwnerNumber,
    ProgramNumber,
)
from openacr.basic.memory.storage import Storage
from openacr.basic.vm.run import LINE_END
from openacr.channels import Attention, EchoMode, startup_mode
from openacr.errors import CardError
from openacr.lang.lexer import Token, spelled, tokens
from openacr.messages import DEVICE_IN_USE, LINE_TOO_LONG
from openacr.motion.card import Card
from openacr.network.drivetalk import lines

FIRST_CHANNEL_THREAD = 16


class Channel(Struct, frozen=True):
    """What a snapshot keeps of a session."""

    level: Literal["SYS", "PROG", "PLC"]
    number: ProgramNumber
    echo: EchoBits
    mode: ModeBits
    busy: bool
    capture: OwnerNumber | None
    listening_to: ProgramNumber | None
    until_end: bool
    opened_by: tuple[ProgramNumber, DeviceNumber] | None
    partner: str | None
    has_called: bool
    drive: ProgramNumber | None
    echo_line_end: bool
    typed_ahead: str
    rest: str
    listed: tuple[LineNumber, LineNumber]
    output: bytes


class Inputs(Protocol):
    """What is typed for programs: the queues of their devices, each a program and a number."""

    def receive(self, key: tuple[int, int], byte: int) -> None:
        """One byte for the device."""

    def is_full(self, key: tuple[int, int]) -> bool:
        """Whether so much waits to be read that the sender is to be held."""

    def take_begun_line(self, key: tuple[int, int]) -> str:
        """The characters after the last line end, which no program will read."""


class Runner(Protocol):
    """Who executes immediate lines: each channel has a thread of its own."""

    def start(self, session: Session, line: StoredLine) -> None:
        """Begin a line; `session.finished` is called when it is done."""

    def cancel(self, session: Session) -> None:
        """Forget a line that is still being executed."""

    def is_waiting(self, thread: int) -> bool:
        """Whether the thread waits (DWL, INH, a full move buffer)."""


class Language(Texts, Protocol):
    """What a channel needs of the language side of its card."""

    @property
    def card(self) -> Card:
        """The card."""

    @property
    def storage(self) -> Storage:
        """What is dimensioned."""

    @property
    def devices(self) -> Inputs:
        """What is typed for programs."""

    @property
    def runner(self) -> Runner:
        """Who executes immediate lines."""

    @property
    def sessions(self) -> Mapping[str, Session]:
        """All channels by their names."""


@dataclass(slots=True)
class Session:
    """One channel of the card; it exists from power-up, connected or not."""

    name: str
    index: int
    system: Language = field(repr=False)
    is_connected: bool = False
    level: Level = Level.SYS
    number: int = 0  # of the program or PLC of the level
    busy: bool = False
    capture: int | None = None  # owner whose text is being entered with PROGRAM
    listening_to: int | None = None
    until_end: bool = False  # LRUN: listen until the program ends
    opened_by: tuple[int, int] | None = None  # program and device number
    partner: str | None = None  # channel joined by TALK TO
    has_called: bool = False  # TALK TO was typed here: its prompt is still to come
    drive: int | None = None  # axis whose drive DTALK has joined
    echo_line_end: bool = True  # False while `INPUT;` reads a line
    typed_ahead: str = ""  # what the program followed with LRUN has left of the line being typed
    listed: tuple[int, int] = (0, 0)  # line at which LIST goes on, and its depth of blocks
    rest: list[Token] = field(default_factory=list)  # of the present line, for its new level
    announcements: list[str] = field(default_factory=list)  # for the next host, once
    last_error: CardError | None = None  # of the latest line, whatever ECHO says
    _output: bytearray = field(default_factory=bytearray)
    _words: ChannelWords = field(init=False, repr=False)

    def __post_init__(self) -> None:
        self._words = ChannelWords(self.name, self.system.card.memory)

    @property
    def thread(self) -> int:
        """The thread that executes lines typed here."""
        return FIRST_CHANNEL_THREAD + self.index

    @property
    def echo(self) -> int:
        """ECHO mode: 1 echo characters, 2 no error reports, 4 no prompt."""
        return self._words.echo

    @echo.setter
    def echo(self, mode: int) -> None:
        self._words.echo = mode

    @property
    def mode(self) -> int:
        """MODE of binary data: 1 control prefixing, 2 high bit stripping."""
        return self._words.mode

    @mode.setter
    def mode(self, mode: int) -> None:
        self._words.mode = mode

    @property
    def program(self) -> int | None:
        """The program whose axes and locals a line means."""
        return self.number if self.level is Level.PROG else None

    @property
    def owner(self) -> int | None:
        """The program (0-15) or PLC (16-23) of the level; None at SYS."""
        if self.level is Level.PLC:
            return PROGRAMS + self.number
        return self.program

    @property
    def attention(self) -> Attention:
        """Who gets what is typed."""
        if self.opened_by is not None:
            return Attention.OPEN
        if self.is_joined:
            return Attention.PASS_THROUGH
        return Attention.COMMANDS if self.listening_to is None else Attention.LISTENING

    @property
    def is_joined(self) -> bool:
        """Whether another channel or a drive gets what is typed."""
        return self.partner is not None or self.drive is not None

    @property
    def prompt(self) -> str:
        """The prompt of the level."""
        if self.level is Level.SYS:
            return "SYS>"
        return f"P{self.number:02d}>" if self.level is Level.PROG else f"PLC{self.number}>"

    @property
    def scope(self) -> Scope:
        """What an immediate line may refer to."""
        return self.system.scope(self.level, self.program, stored=False)

    # connection

    def connect(self) -> None:
        """A host takes the channel: as after power-up, unless a program holds it open."""
        self.is_connected = True
        self.reset()
        for text in self.announcements:
            self.write(text + LINE_END)
        self.announcements.clear()

    def reset(self) -> None:
        """The state after power-up: SYS level, echo on, control prefixing on serial lines."""
        self.level, self.number = Level.SYS, 0
        self.echo, self.mode = EchoMode.CHARACTERS, startup_mode(self.name)
        self.show_waiting(0, 0)
        self._output.clear()

    def disconnect(self) -> None:
        """The host is gone: nothing it started stops, only its unfinished line does."""
        self.is_connected = False
        if self.busy:
            self.system.runner.cancel(self)
            self.busy = False
        self.stop_listening()
        self._leave()
        self.capture, self.typed_ahead, self.rest = None, "", []
        self._output.clear()

    # input

    def feed_line(self, text: str) -> None:
        """Deal with one line; it is answered here, or by `finished` when it takes longer."""
        self.busy, self.listed = True, (0, 0)
        self._words.count_line()
        self._attempt(lambda: self._take(text))

    def show_waiting(self, characters: int, lines: int) -> None:
        """Put what waits in the buffer of the channel into its parameters."""
        self._words.show_waiting(characters, lines, self.system.storage.stream_size(self.name))

    def line_too_long(self) -> None:
        """Answer a line that was discarded for its length."""
        self.finished(CardError(LINE_TOO_LONG))

    def typed(self, byte: int) -> None:
        """One byte for the program or channel that has the attention."""
        if self.is_joined:
            self._pass_on(byte)
        elif (device := self._device) is not None:
            self.system.devices.receive(device, byte)

    @property
    def accepts_input(self) -> bool:
        """False while so much waits for a program to read it that the sender is to be held."""
        device = self._device
        return device is None or not self.system.devices.is_full(device)

    @property
    def _device(self) -> tuple[int, int] | None:
        """The device that gets what is typed; None where it is for the channel."""
        if self.opened_by is not None or self.listening_to is None:
            return self.opened_by
        return self.listening_to, 0

    def escape(self) -> None:
        """ESC: end listening or talking; one prompt follows without a line."""
        if self.attention in (Attention.LISTENING, Attention.PASS_THROUGH):
            self.stop_listening()
            self._leave()
            self.end_mode()

    def _attempt(self, step: Callable[[], bool]) -> None:
        """Deal with a part of the present line; `step` is True when nothing of it is left."""
        try:
            is_done = step()
        except CardError as error:
            self.finished(error)
        else:
            if is_done:
                self.finished()

    def _take(self, text: str) -> bool:
        """Store or start a line."""
        found = Entry(self.system, self).take(text)
        return found is None or self._begin(found)

    def _begin(self, found: list[Token]) -> bool:
        """Start a line up to its first change of level: what follows is read at the new one."""
        now, self.rest = split_at_level(found)
        scope = self.scope
        line = Parser(now, scope).line()
        if line.is_empty:
            return True
        self.system.runner.start(self, StoredLine(0, None, scope, 0, (tuple(now), line)))
        return False

    # output

    def write(self, text: str) -> None:
        """Queue text for the host; without a host it is dropped."""
        if self.is_connected:
            self._output += text.encode("latin-1", errors="replace")

    def finished(self, error: CardError | None = None) -> None:
        """The present line is dealt with: its error text, then the prompt."""
        rest, self.rest = self.rest, []
        if rest and error is None:
            self._attempt(lambda: self._begin(rest))
            return
        self.busy = False
        self.last_error = error
        if error is not None and not self.echo & EchoMode.NO_ERRORS:
            self.write(error.text + LINE_END)
        if self.attention is Attention.COMMANDS:
            self._send_prompt()

    def take_output(self) -> bytes:
        """What there is to send; the answer of a line that is still computing is held back."""
        if self.busy and not self.system.runner.is_waiting(self.thread):
            return b""
        data = bytes(self._output)
        self._output.clear()
        return data

    @property
    def has_output(self) -> bool:
        """Whether anything waits to be sent."""
        return bool(self._output)

    def end_mode(self) -> None:
        """Answer the line that has begun LISTEN, TALK TO or DTALK: one prompt, in a new line."""
        self.write(LINE_END)
        self._send_prompt()

    def _send_prompt(self) -> None:
        if not self.echo & EchoMode.NO_PROMPT:
            self.write(self.prompt)

    # joined with another channel (TALK TO) or with a drive (DTALK), until ESC

    def join_channel(self, other: Session) -> None:
        """TALK TO: what is typed on one channel leaves on the other."""
        if other.opened_by is not None or other.is_joined:
            raise CardError(DEVICE_IN_USE)
        self.partner, other.partner = other.name, self.name
        self.has_called = True

    def join_drive(self, axis: int, port: int) -> None:
        """DTALK: what is typed goes to the drive of an axis, over a Drive Talk line."""
        lines.connect(self.system.card.memory, port, self.index, axis)
        self.drive = axis

    def _pass_on(self, byte: int) -> None:
        """One byte typed while joined."""
        if self.drive is not None:
            shown = lines.type_byte(self.system.card.memory, self.index, byte)
            if self.echo & EchoMode.CHARACTERS:
                self.write(shown)
        elif self.partner is not None:
            self.system.sessions[self.partner].write(chr(byte))

    def _leave(self) -> None:
        """End it from this side; the line on the other side that has begun it is answered now."""
        if self.drive is not None:
            lines.disconnect(self.system.card.memory, self.index)
        if self.partner is not None:
            other = self.system.sessions[self.partner]
            if other.has_called:
                other.end_mode()
            other.partner, other.has_called = None, False
        self.drive, self.partner, self.has_called = None, None, False

    # levels and modes

    def go(self, level: Level, number: int = 0) -> None:
        """SYS, PROG n, PLC n."""
        self.level, self.number = level, number

    def listen(self, program: int, *, until_end: bool = False) -> None:
        """LISTEN, LRUN: the output of a program goes here until ESC."""
        self.listening_to, self.until_end = program, until_end

    def stop_listening(self) -> None:
        """Stop following a program."""
        self.listening_to, self.until_end, self.echo_line_end = None, False, True

    def program_ended(self) -> None:
        """The program followed with LRUN has ended: back to the prompt, once."""
        if self.listening_to is not None:
            self.typed_ahead = self.system.devices.take_begun_line((self.listening_to, 0))
        self.stop_listening()
        if not self.busy:
            self._send_prompt()

    def power_up(self) -> None:
        """Begin as after power-up; the connection, if there is one, stays."""
        self.stop_listening()
        self.busy, self.capture, self.opened_by, self.partner = False, None, None, None
        self.drive, self.has_called, self.rest = None, False, []
        self.reset()

    # snapshot

    def state(self) -> Channel:
        """Everything but the connection."""
        level: Any = self.level.name
        return Channel(
            **{name: getattr(self, name) for name in _PLAIN},
            level=level,
            rest=spelled(self.rest),
            output=bytes(self._output),
        )

    def restore(self, state: Channel) -> None:
        """Take over what `state` returned."""
        for name in _PLAIN:
            setattr(self, name, getattr(state, name))
        self.level = Level[state.level]
        self.rest = tokens(state.rest.encode("latin-1")) if state.rest else []
        self._output[:] = state.output


_PLAIN = tuple(set(Channel.__struct_fields__) - {"level", "rest", "output"})
