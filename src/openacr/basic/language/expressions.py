"""Read expressions: precedence climbing over one table of operators."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from openacr.basic.language import registry
from openacr.basic.language.cursor import Cursor
from openacr.basic.language.nodes import (
    Alias,
    Apply,
    Binary,
    Element,
    Expr,
    Flag,
    Local,
    LocalKind,
    Number,
    Op,
    Parameter,
    String,
    StringElement,
    StringLocal,
    Unary,
    is_text,
)
from openacr.lang.lexer import Token, TokenKind
from openacr.messages import SYNTAX_ERROR, TYPE_MISMATCH, UNDEFINED_SYMBOL

# How tightly each binary operator binds; equal levels go left to right.
BINARY = {
    "OR": 1, "NOR": 1, "XOR": 1, "XNOR": 1,
    "AND": 2, "NAND": 2,
    "=": 4, "<>": 4, "<": 4, ">": 4, "<=": 4, ">=": 4,
    "<<": 5, ">>": 5,
    "+": 6, "-": 6,
    "*": 7, "/": 7, "MOD": 7,
}  # fmt: skip
NOT_LEVEL = 3
SIGN_LEVEL = 8  # looser than `**`: -2**2 is -4

_LOCALS = {"LV": LocalKind.LONG, "SV": LocalKind.SINGLE, "DV": LocalKind.DOUBLE}
_ARRAYS = {"LA": LocalKind.LONG, "SA": LocalKind.SINGLE, "DA": LocalKind.DOUBLE}
_RELATIONS = frozenset(("=", "<>", "<", ">", "<=", ">="))


class ExpressionReader:
    """Reads expressions, variables and values at a cursor."""

    def __init__(self, cursor: Cursor, aliases: Mapping[str, Expr]) -> None:
        self._cursor = cursor
        self._aliases = aliases

    # expressions

    def expression(self) -> Expr:
        """One expression, as far as it goes."""
        return self._binary(1)

    def numeric(self) -> Expr:
        """An expression whose value must be a number."""
        start = self._cursor.position
        node = self.expression()
        if is_text(node):
            raise self._cursor.error_from(start, TYPE_MISMATCH)
        return node

    def _binary(self, lowest: int) -> Expr:
        start = self._cursor.position
        if lowest <= NOT_LEVEL and self._cursor.accept("NOT"):
            left = self._checked(Op.NOT, self._binary(NOT_LEVEL), start)
        else:
            left = self._operand()
        while (level := self._level_here()) >= lowest:
            op = Op(self._cursor.advance().value)
            left = self._joined(op, left, self._right(level), start)
        return left

    def _right(self, level: int) -> Expr:
        """The right operand; NOT is accepted there and takes the rest up to AND or OR."""
        start = self._cursor.position
        if self._cursor.accept("NOT"):
            return self._checked(Op.NOT, self._binary(NOT_LEVEL), start)
        return self._binary(level + 1)

    def _level_here(self) -> int:
        token = self._cursor.token
        if token.kind not in (TokenKind.OPERATOR, TokenKind.WORD):
            return 0
        return BINARY.get(str(token.value), 0)

    def _operand(self) -> Expr:
        """A value with its signs and powers."""
        return self._signed(self._power)

    def _power(self) -> Expr:
        """Powers have one rank, so they go left to right: 2**3**2 is 64."""
        start = self._cursor.position
        base = self._primary()
        while self._cursor.accept("**"):
            base = self._joined(Op.POWER, base, self._signed(self._primary), start)
        return base

    def _signed(self, inner: Callable[[], Expr]) -> Expr:
        start = self._cursor.position
        for sign in (Op.MINUS, Op.PLUS):
            if self._cursor.accept(sign.value):
                if self._cursor.accept("NOT"):
                    inverse = self._checked(Op.NOT, self._binary(NOT_LEVEL), start)
                    return self._checked(sign, inverse, start)
                return self._checked(sign, self._signed(inner), start)
        return inner()

    def _checked(self, op: Op, operand: Expr, start: int) -> Expr:
        if is_text(operand):
            raise self._cursor.error_from(start, TYPE_MISMATCH)
        if op is Op.MINUS and isinstance(operand, Number):
            return Number(-operand.value if operand.value else 0)
        return Unary(op, operand)

    def _joined(self, op: Op, left: Expr, right: Expr, start: int) -> Expr:
        texts = is_text(left) + is_text(right)
        if texts == 1 or (texts == 2 and op is not Op.PLUS and op.value not in _RELATIONS):
            raise self._cursor.error_from(start, TYPE_MISMATCH)
        return Binary(op, left, right)

    def _primary(self) -> Expr:
        token = self._cursor.token
        if token.kind is TokenKind.NUMBER:
            self._cursor.position += 1
            return Number(token.value)  # type: ignore[arg-type]
        if token.kind is TokenKind.STRING:
            self._cursor.position += 1
            return String(str(token.value))
        if self._cursor.accept("("):
            inner = self.expression()
            self._cursor.expect(")")
            return inner
        if token.kind is TokenKind.WORD:
            return self._named()
        raise self._cursor.error(SYNTAX_ERROR)

    def _named(self) -> Expr:
        if self.at_variable:
            return self.variable()
        word = str(self._cursor.token.value)
        if word in registry.functions:
            return self._application(registry.functions[word])
        raise self._cursor.error(SYNTAX_ERROR if word in registry.keywords() else UNDEFINED_SYMBOL)

    def _application(self, function: registry.Function) -> Expr:
        start = self._cursor.position
        self._cursor.advance()
        arguments: list[Expr] = []
        if self._cursor.is_operator("(") or function.fewest:
            self._cursor.expect("(")
            arguments.append(self.expression())
            while self._cursor.accept(","):
                arguments.append(self.expression())
            self._cursor.expect(")")
        if not function.fewest <= len(arguments) <= len(function.takes):
            raise self._cursor.error_from(start, SYNTAX_ERROR)
        if not function.accepts([is_text(argument) for argument in arguments]):
            raise self._cursor.error_from(start, TYPE_MISMATCH)
        return Apply(function, tuple(arguments))

    # variables

    @property
    def at_variable(self) -> bool:
        """Whether a variable, parameter, flag or alias begins here."""
        token = self._cursor.token
        return token.kind is TokenKind.WORD and (
            token.text in self._aliases or token.value in registry.VARIABLES
        )

    def variable(self) -> Expr:
        """The variable, parameter, flag or alias that begins here."""
        token = self._cursor.advance()
        if token.text in self._aliases:
            return Alias(token.text, self._aliases[token.text])
        word = str(token.value)
        index = self.object_index()
        if word in _ARRAYS:
            return Element(_ARRAYS[word], index, self._subscript())
        if word in _LOCALS:
            return Local(_LOCALS[word], index)
        if word == "$A":
            return StringElement(index, self._subscript())
        if word == "$V":
            return StringLocal(index)
        return Parameter(index) if word == "P" else Flag(index)

    def _subscript(self) -> Expr:
        self._cursor.expect("(")
        index = self.numeric()
        self._cursor.expect(")")
        return index

    @property
    def at_object_index(self) -> bool:
        """Whether the number of an object, a literal or `(expr)`, begins here."""
        return self._cursor.token.kind is TokenKind.NUMBER or self._cursor.is_operator("(")

    def object_index(self) -> Expr:
        """The number of an object or variable: a whole literal or `(expr)`."""
        token = self._cursor.token
        if token.kind is TokenKind.NUMBER and isinstance(token.value, int):
            self._cursor.position += 1
            return Number(token.value)
        return self._subscript()

    # values after a command word

    @property
    def at_value(self) -> bool:
        """Whether a number, a signed number, a variable or `(expr)` begins here."""
        if self._cursor.token.kind is TokenKind.OPERATOR and self._cursor.token.value in ("-", "+"):
            following = self._cursor.ahead(1)
            return (
                following.kind is TokenKind.NUMBER
                or following.value == "("
                or self._names_number(following)
            )
        return self.at_object_index or self._names_number(self._cursor.token)

    def _names_number(self, token: Token) -> bool:
        if token.kind is not TokenKind.WORD:
            return False
        if token.text in self._aliases:
            return not is_text(self._aliases[token.text])
        return token.value in registry.VARIABLES and not str(token.value).startswith("$")

    def value(self) -> Expr:
        """A number, a signed number, a variable or `(expr)`; anything longer needs parentheses."""
        for sign in (Op.MINUS, Op.PLUS):
            if self._cursor.accept(sign.value):
                operand = self.value()
                if isinstance(operand, Number):
                    return Number(-operand.value if sign is Op.MINUS else operand.value)
                return Unary(sign, operand)
        if self._cursor.token.kind is TokenKind.NUMBER:
            return Number(self._cursor.advance().value)  # type: ignore[arg-type]
        if self._cursor.accept("("):
            node = self.numeric()
            self._cursor.expect(")")
            return node
        if self._names_number(self._cursor.token):
            return self.variable()
        raise self._cursor.error(SYNTAX_ERROR)
