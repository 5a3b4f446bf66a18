"""Read one line of AcroBASIC into a tree.

Every command takes its own arguments as far as they go; the next word then begins a new
command, so `ACC 10 DEC 10 VEL 5 X10` needs no separators. After a command without
arguments that word may be an argument the command does not have: it is refused, and a
separator makes it a new command (`CLEAR PROG3`, `CLEAR : PROG3`). What the arguments of a
command look like is said by its row in the registry; this module knows the rules that
hold for all of them.
"""

from __future__ import annotations

from openacr.basic.language import registry
from openacr.basic.language.cursor import Cursor, StatementError
from openacr.basic.language.expressions import ExpressionReader
from openacr.basic.language.nodes import AxisRef, Block, Expr, LineTree, Move, Prefix, Statement
from openacr.basic.language.registry import Command, Level, Use
from openacr.basic.language.scope import Scope, join_names
from openacr.errors import CardError
from openacr.lang.lexer import Token, TokenKind
from openacr.lang.source import Span
from openacr.messages import (
    NOT_SUPPORTED,
    NOT_VALID_AT_THIS_LEVEL,
    SYNTAX_ERROR,
    UNDEFINED_SYMBOL,
    UNKNOWN_COMMAND,
)

LONGEST_LABEL = 32
PREFIXES = frozenset(("AXIS", "MASTER"))
KNOT, WEIGHT = "K", "W"  # of a point of a curve, where no axis has this name
LEVEL_WORDS = frozenset(("SYS", "PROG", "PLC"))  # as a command each begins a block


class Parser:
    """A cursor over the tokens of one line; aliases with digits become one token there."""

    def __init__(self, found: list[Token], scope: Scope) -> None:
        if scope.numbered:
            join_names(found, scope.numbered)
        self.cursor = Cursor(found)
        self.expressions = ExpressionReader(self.cursor, scope.aliases)
        self.scope = scope
        self.prefix: Prefix | None = None
        self.has_knot = False  # the present block gives the knot of a point of a curve
        self.names_object = False  # the present statement names AXISn, PROGn, ...

    # lines and blocks

    def line(self) -> LineTree:
        """The whole line, without the number in front of a stored one."""
        label = self._label()
        blocks = self.rest_of_line()
        remark = self.remark_here
        if remark is not None:
            self.cursor.advance()
        if self.cursor.token.kind is not TokenKind.END:
            raise self.cursor.error(SYNTAX_ERROR)
        return LineTree(label, blocks, remark)

    @property
    def remark_here(self) -> str | None:
        """The text of the remark at the cursor, if there is one."""
        return str(self.cursor.token.value) if self.cursor.token.kind is TokenKind.REMARK else None

    def rest_of_line(self) -> tuple[Block, ...]:
        """All blocks up to the end of the line or the remark there."""
        found = [self._block()]
        while self.cursor.accept(":"):
            found.append(self._block())
        return tuple(found)

    def _label(self) -> str | None:
        """A label stands alone or before a colon."""
        if self.cursor.token.kind is not TokenKind.LABEL:
            return None
        if not self.scope.stored:
            at_sys = self.scope.level is Level.SYS
            raise self.cursor.error(UNKNOWN_COMMAND if at_sys else NOT_VALID_AT_THIS_LEVEL)
        label = str(self.cursor.advance().value)
        stands_alone = self.cursor.at_block_end and self.remark_here is None
        if len(label) > LONGEST_LABEL or not stands_alone:
            raise self.cursor.error(SYNTAX_ERROR)
        return label

    def _block(self) -> Block:
        """The statements up to a colon; all targets among them become one move at the end."""
        done: list[Statement | Move] = []
        parts: list[Statement] = []
        statement: Statement | None = None
        self.has_knot = False
        while not self.cursor.at_block_end:
            if statement is not None and (statement.is_bare or self.cursor.is_word(*LEVEL_WORDS)):
                raise self.cursor.error(UNKNOWN_COMMAND if self.at_unknown_word else SYNTAX_ERROR)
            statement = self.statement()
            (parts if statement.command.move else done).append(statement)
        if parts:
            done.append(Move(tuple(parts), parts[0].column))
        return tuple(done)

    # statements

    def statement(self) -> Statement:
        """One command with its arguments, an assignment, or the targets of a move."""
        token = self.cursor.token
        if token.kind is TokenKind.WORD and token.text in self.scope.aliases:
            return self._implied("LET")
        if (key := self._command_word()) is not None:
            return self._command(key)
        if token.kind is not TokenKind.WORD:
            raise self.cursor.error(SYNTAX_ERROR)
        if token.value in registry.VARIABLES:
            return self._implied("LET")
        if token.value in self.scope.axes:
            return self._implied("MOV")
        if token.value == KNOT or (token.value == WEIGHT and self.has_knot):
            self.has_knot = True
            self.cursor.advance()
            return self._implied(str(token.value))
        raise self.cursor.error(UNKNOWN_COMMAND)

    def _command_word(self) -> str | None:
        """The key of the word tree at the cursor, if a command begins there."""
        token = self.cursor.token
        key = str(token.value)
        if token.kind is TokenKind.OPERATOR and key == "#":
            key = f"#{self.cursor.ahead(1).value}"
        elif token.kind not in (TokenKind.WORD, TokenKind.OPERATOR):
            return None
        return key if key in registry.root.children else None

    def _implied(self, name: str) -> Statement:
        """A statement whose command word is not written."""
        row = registry.find(name)
        column = self.cursor.token.column
        self._check_level(row)
        return self._with_arguments(row, (), column)

    def _command(self, key: str) -> Statement:
        column = self.cursor.token.column
        if key in PREFIXES and (prefixed := self._prefixed()) is not None:
            return prefixed
        row, indices = self._walk()
        self._check_level(row)
        return self._with_arguments(row, indices, column)

    def _prefixed(self) -> Statement | None:
        """`AXISn command ...`: the command with its axis or master already named."""
        start = self.cursor.position
        word = str(self.cursor.advance().value)
        number = self.expressions.object_index()
        daughters = registry.root.children[word].children.get(registry.INDEX)
        own = daughters.children if daughters else {}
        key = self._command_word()
        if key is None or key in own or key in PREFIXES:
            self.cursor.position = start
            return None
        self.prefix, self.names_object = Prefix(word, number), True
        try:
            column = self.cursor.token.column
            row, indices = self._walk()
            self._check_prefix(row, word)
            return self._with_arguments(row, indices, column)
        finally:
            self.prefix, self.names_object = None, False

    def _check_prefix(self, row: Command, word: str) -> None:
        self._check_level(row)
        names_axes = any(form.names_axes for form in row.grammar)
        if not row.levels & Level.SYS_BY_OBJECT or names_axes is not (word == "AXIS"):
            raise self.cursor.error(SYNTAX_ERROR)

    def _walk(self) -> tuple[Command, tuple[Expr, ...]]:
        """The command with the longest sequence of words that stands here."""
        node = registry.root
        indices: tuple[Expr, ...] = ()
        best: tuple[Command, tuple[Expr, ...], int] | None = None
        while True:
            key = str(self.cursor.token.value)
            if self.cursor.is_operator("#") and node is registry.root:
                self.cursor.advance()
                key = f"#{self.cursor.token.value}"
            is_key = (
                self.cursor.token.kind in (TokenKind.WORD, TokenKind.OPERATOR)
                and key != registry.INDEX
            )
            if is_key and key in node.children:
                self.cursor.advance()
                node = node.children[key]
            elif registry.INDEX in node.children and self.expressions.at_object_index:
                indices = (*indices, self.expressions.object_index())
                node = node.children[registry.INDEX]
            else:
                break
            if node.command is not None:
                best = node.command, indices, self.cursor.position
        if best is None:
            raise self.cursor.error(SYNTAX_ERROR)
        self.cursor.position = best[2]
        return best[0], best[1]

    def _check_level(self, row: Command) -> None:
        """Refuse a command that cannot stand here whatever its arguments are."""
        level = self.scope.level
        if self.scope.stored:
            if not row.use & Use.PROGRAM:
                raise self.cursor.error(NOT_VALID_AT_THIS_LEVEL)
        elif level is Level.SYS:
            allowed = row.levels & (Level.SYS | Level.SYS_BY_OBJECT)
            if not allowed or not row.use & Use.IMMEDIATE:
                raise self.cursor.error(UNKNOWN_COMMAND)
        elif not row.use & Use.IMMEDIATE or not row.levels & (level | Level.SYS_BY_OBJECT):
            raise self.cursor.error(NOT_VALID_AT_THIS_LEVEL)

    def _with_arguments(self, row: Command, indices: tuple[Expr, ...], column: int) -> Statement:
        if self.prefix is None:
            self.names_object = False
        at_sys = self.scope.level is Level.SYS and not self.scope.stored
        needs_object = at_sys and not row.levels & Level.SYS
        try:
            arguments = self.arguments(row)
        except CardError:
            if needs_object:
                raise self._unknown(row, column) from None
            raise
        if needs_object and not self.names_object:
            raise self._unknown(row, column)
        if row.needs & self.scope.lacks:
            raise StatementError(
                NOT_SUPPORTED, Span(self.cursor.token.line, column, len(row.words[0]))
            )
        return Statement(row, arguments, indices, self.prefix, column)

    def _unknown(self, row: Command, column: int) -> StatementError:
        span = Span(self.cursor.token.line, column, len(row.words[0]))
        return StatementError(UNKNOWN_COMMAND, span)

    def arguments(self, row: Command) -> tuple[object, ...]:
        """The arguments of a command, in the order of its grammar; None for one left out."""
        found: list[object] = []
        for form in row.grammar:
            if form.starts(self):
                read = form.parse(self)
                if not form.silent:
                    found.append(read)
            elif form.optional:
                found.append(None)
            else:
                raise self.cursor.error(form.missing(self))
        return tuple(found)

    # axes

    @property
    def at_axis(self) -> bool:
        """Whether an axis is named here."""
        token = self.cursor.token
        if token.kind is not TokenKind.WORD or token.text in self.scope.aliases:
            return False
        if token.value == "AXIS":
            return self.cursor.ahead(1).kind is TokenKind.NUMBER or self.cursor.ahead(1).text == "("
        return token.value in self.scope.axes and token.value not in registry.root.children

    @property
    def at_unknown_word(self) -> bool:
        """Whether a word stands here that means nothing at all."""
        token = self.cursor.token
        return (
            token.kind is TokenKind.WORD
            and token.text not in self.scope.aliases
            and token.value not in registry.root.children
            and token.value not in self.scope.axes
            and token.value not in registry.keywords()
        )

    def begins_command(self, token: Token) -> bool:
        """Whether this word begins a command."""
        return token.text not in self.scope.aliases and token.value in registry.root.children

    def axis(self) -> AxisRef:
        """The axis named here; at SYS axes have no names."""
        if not self.at_axis:
            at_sys = self.scope.level is Level.SYS
            unknown = UNKNOWN_COMMAND if at_sys else UNDEFINED_SYMBOL
            raise self.cursor.error(unknown if self.at_unknown_word else SYNTAX_ERROR)
        name = str(self.cursor.advance().value)
        if name != "AXIS":
            return AxisRef(name)
        self.names_object = True
        return AxisRef(name, self.expressions.object_index())
