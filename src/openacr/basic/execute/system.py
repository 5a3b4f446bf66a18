"""Everything AcroBASIC knows beside the memory map, and who is asked for what."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol

from msgspec.structs import replace

from openacr.basic.channels.devices import Devices
from openacr.basic.channels.listeners import Listeners
from openacr.basic.channels.session import Runner, Session
from openacr.basic.language.aliases import Aliases
from openacr.basic.language.parser import Parser
from openacr.basic.language.registry import Level
from openacr.basic.language.scope import Scope
from openacr.basic.memory import retained
from openacr.basic.memory.known_lines import KnownLines
from openacr.basic.memory.memory_cost import PLC_INSTRUCTION, line_bytes
from openacr.basic.memory.program_memory import PROGRAMS
from openacr.basic.memory.program_store import OWNERS, ProgramStore, StoredLine
from openacr.basic.memory.setup import Setup
from openacr.basic.memory.storage import STREAMS, Storage
from openacr.errors import CardError
from openacr.lang.lexer import Token, tokens
from openacr.messages import NOT_SUPPORTED

if TYPE_CHECKING:
    from openacr.motion.card import Card

PlcReader = Callable[[list[Token], Scope], tuple[Any, int]]


class Control(Protocol):
    """Who runs programs (0-15) and PLCs (16-23)."""

    def is_running(self, owner: int) -> bool:
        """Whether it executes, waits or is held."""

    def run(self, owner: int, line: int | None = None) -> None:
        """RUN: begin at the first line or at `line`."""

    def halt(self, owner: int) -> None:
        """HALT, motion of its master included."""

    def pause(self, owner: int) -> None:
        """PAUSE."""

    def resume(self, owner: int) -> None:
        """RESUME."""

    def block(self, owner: int) -> None:
        """BLK."""

    def auto(self, owner: int) -> None:
        """AUT."""

    def step(self, owner: int) -> None:
        """STEP."""

    def trace(self, owner: int, on: bool) -> None:
        """TRON and TROFF."""


class NonVolatile(Protocol):
    """What the card keeps without power: saved parameters, user flash, battery, firmware."""

    def esave(self) -> None:
        """ESAVE."""

    def eload(self) -> None:
        """ELOAD."""

    def erase(self) -> None:
        """ERASE."""

    def flash_save(self, *, values: bool) -> None:
        """FLASH SAVE, with values FLASH IMAGE."""

    def flash_load(self) -> None:
        """FLASH LOAD."""

    def flash_erase(self) -> None:
        """FLASH ERASE."""

    def breset(self) -> None:
        """BRESET."""

    def firmware_backup(self) -> None:
        """FIRMWARE BACKUP."""

    def firmware_checksum(self) -> None:
        """FIRMWARE CHECKSUM."""


def _no_plc(found: list[Token], scope: Scope) -> tuple[Any, int]:
    raise CardError(NOT_SUPPORTED)


class System:
    """The language side of one card.

    `control` and `runner` execute, `reboot` restarts the card, `nonvolatile` stores; they
    are set by the composition root, as is `read_plc`, which turns the tokens of a PLC line into
    instructions and their count.
    """

    control: Control
    runner: Runner
    reboot: Callable[[], None]
    nonvolatile: NonVolatile

    def __init__(self, card: Card) -> None:
        self.card = card
        streams = card.model.streams
        self.storage = Storage(card.memory, streams=streams)
        self.aliases = Aliases(
            lambda: self.storage.define_count, has_digits=card.model.has_digits_in_names
        )
        self.programs = ProgramStore(self.storage)
        self.known_lines = KnownLines()
        self._last_scope = Scope(lacks=card.model.lacks)
        self.sessions = {
            name: Session(name, index, self)
            for index, name in enumerate(STREAMS)
            if name in streams
        }
        for session in self.sessions.values():
            session.reset()
        self.listeners = Listeners(self.sessions)
        self.devices = Devices(card.memory, self.sessions, self.listeners)
        self.setup: Setup = Setup()
        self.read_plc: PlcReader = _no_plc

    def scope(self, level: Level, program: int | None, *, stored: bool) -> Scope:
        """What a line of a program, or one typed at its prompt, may refer to."""
        axes = frozenset[str]() if program is None else self.card.attachments.names(program)
        last, nodes = self._last_scope, self.aliases.nodes
        is_level = last.level is level and last.stored is stored
        if is_level and last.aliases is nodes and last.axes is axes:
            return last  # line after line
        self._last_scope = Scope(
            level, stored, axes, nodes, self.aliases.numbered, self.card.model.lacks
        )
        return self._last_scope

    def read_stored(
        self,
        owner: int,
        number: int,
        text: str,
        names: frozenset[str] = frozenset(),
        *,
        found: list[Token] | None = None,
    ) -> StoredLine | None:
        """A line to be stored, from its text and tokens; None if there is nothing to store.

        `names` are axes it may name besides those that are attached.
        """
        if found is None:
            found = tokens(text.encode("latin-1"))
        if owner >= PROGRAMS:
            return self.read_plc_line(number, text, self.scope(Level.PLC, None, stored=True), found)
        scope = self.scope(Level.PROG, owner, stored=True)
        if names:
            scope = replace(scope, axes=scope.axes | names)
        line = Parser(found, scope).line()
        if line.is_empty:
            return None
        return StoredLine(number, text, scope, line_bytes(found), (tuple(found), line))

    def read_plc_line(
        self, number: int, text: str, scope: Scope, found: list[Token]
    ) -> StoredLine | None:
        """A line of a PLC."""
        tree, count = self.read_plc(found, scope)
        if tree is None:
            return None
        return StoredLine(number, text, scope, count * PLC_INSTRUCTION.each, (tuple(found), tree))

    def start_boot_programs(self) -> None:
        """Start every program and PLC whose first statement is PBOOT.

        One that cannot start keeps no other from starting; the first error is raised.
        """
        errors: list[CardError] = []
        for owner in self.owners():
            if self.programs.starts_by_itself(owner) and not self.control.is_running(owner):
                try:
                    self.control.run(owner)
                except CardError as error:
                    errors.append(error)
        if errors:
            raise errors[0]

    def forget(self) -> None:
        """Forget programs, dimensions and aliases: memory without a battery."""
        for owner in self.owners():
            self.programs.forget(owner)
        self.programs.password = None
        self.storage.restore_factory()
        for name in self.storage.streams:
            self.storage.clear_stream(name)
        self.aliases.clear()

    def restart(self, *, keeps_memory: bool = True) -> None:
        """Restart the card; battery-backed memory keeps texts, dimensions and variables."""
        for program in range(PROGRAMS):
            self.devices.close_all(program)
        kept = retained.take(self.card.memory) if keeps_memory else []
        self.card.power_up()
        if keeps_memory:
            retained.put_back(self.card.memory, kept)
        else:
            self.forget()
            self.setup = Setup()
        self.devices.restore([])
        for session in self.sessions.values():
            session.power_up()

    def owners(self) -> range:
        """All programs and PLCs."""
        return range(OWNERS)
