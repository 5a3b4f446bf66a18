"""Lines as a table of plain data: their texts, and what each may refer to, everything once.

What a line means was decided when it was entered, by the axes attached and the aliases defined
then. A table therefore keeps these with the text: read again, the line means the same.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

from msgspec import Struct

from openacr.basic.language.aliases import Aliases, Names, Written, read_target
from openacr.basic.language.parser import Parser
from openacr.basic.language.registry import Level
from openacr.basic.language.scope import Scope
from openacr.basic.memory.program_store import StoredLine
from openacr.basic.memory.ranges import Index, IndexOrNone, LineNumber
from openacr.errors import StoreError
from openacr.lang.lexer import TokenKind, tokens

if TYPE_CHECKING:
    from openacr.basic.execute.system import System


class Definition(Struct, frozen=True, array_like=True):
    """The target of an alias, and the earlier definitions of the aliases in it."""

    text: str
    uses: dict[str, Index]


class NamesState(Struct, frozen=True, array_like=True):
    """All aliases of one moment: those of an earlier entry (-1: none) and these definitions."""

    base: IndexOrNone
    added: dict[str, Index]


class ScopeState(Struct, frozen=True, array_like=True):
    """What a line may refer to."""

    level: Literal["SYS", "PROG", "PLC"]
    stored: bool
    axes: list[str]
    names: Index


class LineState(Struct, frozen=True, array_like=True):
    """One line; typed lines have the number 0."""

    number: LineNumber
    text: str
    scope: Index


class SourceTable(Struct, frozen=True):
    """Lines, their scopes, the aliases in these and how they were defined."""

    definitions: list[Definition]
    names: list[NamesState]
    scopes: list[ScopeState]
    lines: list[LineState]


class Collector:
    """Collects lines; `index` and `names` say where they are in the table."""

    def __init__(self) -> None:
        self.table = SourceTable([], [], [], [])
        self._known: dict[int, int] = {}  # by the id of an object that lives meanwhile
        self._scopes: dict[tuple[Level, bool, frozenset[str], int], int] = {}
        self._latest = Names()

    def index(self, line: StoredLine) -> int:
        """The place of a line."""
        known = self._known.get(id(line))
        if known is None:
            scope = self._scope(line.scope)
            known = self._add(line, self.table.lines, LineState(line.number, line.text, scope))
        return known

    def names(self, names: Names) -> int:
        """The place of all aliases of a moment."""
        known = self._known.get(id(names))
        if known is None:
            before = self._latest.written
            has_base = bool(self.table.names) and before.keys() <= names.written.keys()
            base = len(self.table.names) - 1 if has_base else -1
            added = {
                name: self._definition(written)
                for name, written in names.written.items()
                if not has_base or before.get(name) is not written
            }
            known = self._add(names, self.table.names, NamesState(base, added))
            self._latest = names
        return known

    def _scope(self, scope: Scope) -> int:
        known = self._known.get(id(scope))
        if known is None:
            names = scope.aliases if isinstance(scope.aliases, Names) else NO_NAMES
            key = scope.level, scope.stored, scope.axes, id(names)
            known = self._scopes.get(key)
            if known is None:
                level: Any = scope.level.name
                axes = sorted(scope.axes)
                state = ScopeState(level, scope.stored, axes, self.names(names))
                known = self._scopes[key] = len(self.table.scopes)
                self.table.scopes.append(state)
            self._known[id(scope)] = known
        return known

    def _definition(self, written: Written) -> int:
        """Those it uses come first, however deep."""
        waiting = [written]
        while waiting:
            each = waiting[-1]
            missing = [used for used in each.uses.values() if id(used) not in self._known]
            waiting += missing
            if not missing:
                waiting.pop()
                if id(each) not in self._known:
                    uses = {name: self._known[id(used)] for name, used in each.uses.items()}
                    self._add(each, self.table.definitions, Definition(each.text, uses))
        return self._known[id(written)]

    def _add(self, owner: object, entries: list[Any], entry: object) -> int:
        place = self._known[id(owner)] = len(entries)
        entries.append(entry)
        return place


NO_NAMES = Names()


class Sources:
    """The objects a table describes; CardError or StoreError where it makes no sense."""

    def __init__(self, table: SourceTable, system: System) -> None:
        self._system, self._aliases = system, system.aliases
        self._definitions: list[tuple[Any, Written]] = []
        for definition in table.definitions:
            self._definitions.append(self._defined(definition))
        self.names: list[Names] = []
        for names in table.names:
            self.names.append(self._names(names))
        self._scopes = [self._scope(scope) for scope in table.scopes]
        self.lines = [self._line(line) for line in table.lines]

    def _defined(self, definition: Definition) -> tuple[Any, Written]:
        found = {name: self._definitions[place] for name, place in definition.uses.items()}
        written = Written(definition.text, {name: each for name, (_, each) in found.items()})
        names = Names({name: node for name, (node, _) in found.items()}, written.uses)
        p = Parser(tokens(definition.text.encode("latin-1")), _scope_of(self._aliases, names))
        node = read_target(p)
        if p.cursor.token.kind is not TokenKind.END:
            raise StoreError(f"an alias cannot stand for {definition.text!r}")
        return node, written

    def _names(self, state: NamesState) -> Names:
        base = self.names[state.base] if state.base >= 0 else NO_NAMES
        added = {name: self._definitions[place] for name, place in state.added.items()}
        return Names(
            {**base, **{name: node for name, (node, _) in added.items()}},
            {**base.written, **{name: written for name, (_, written) in added.items()}},
        )

    def _scope(self, state: ScopeState) -> Scope:
        names = self.names[state.names]
        numbered = self._aliases.numbered_in(names)
        axes, lacks = frozenset(state.axes), self._system.card.model.lacks
        return Scope(Level[state.level], state.stored, axes, names, numbered, lacks)

    def _line(self, state: LineState) -> StoredLine:
        scope = self._scopes[state.scope]
        if scope.level is not Level.PLC or not scope.stored:
            return StoredLine(state.number, state.text, scope)
        found = tokens(state.text.encode("latin-1"))
        line = self._system.read_plc_line(state.number, state.text, scope, found)
        if line is None:
            raise StoreError(f"line {state.number} of a PLC is empty")
        return line


def _scope_of(aliases: Aliases, names: Names) -> Scope:
    return Scope(Level.SYS, False, frozenset(), names, aliases.numbered_in(names))
