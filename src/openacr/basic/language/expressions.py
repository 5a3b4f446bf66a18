"""Read expressions: precedence climbing over one table of operators."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from openacr.basic.language import registry
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
from openacr.errors import CardError
from openacr.lang.lexer import Token, TokenKind
from openacr.lang.source import Span
from openacr.messages import SYNTAX_ERROR, TYPE_MISMATCH, UNDEFINED_SYMBOL, Message

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


class StatementError(CardError):
    """A line that cannot be read, with the place where reading stopped."""

    def __init__(self, message: Message, span: Span, detail: object = "") -> None:
        super().__init__(message, detail)
        self.span = span


class ExpressionParser:
    """A cursor over tokens that reads expressions."""

    def __init__(self, found: list[Token], aliases: Mapping[str, Expr]) -> None:
        self.tokens = found
        self.aliases = aliases
        self.position = 0

    # the cursor

    @property
    def token(self) -> Token:
        """The token at the cursor; the last one is of kind END."""
        return self.tokens[self.position]

    def ahead(self, count: int) -> Token:
        """The token `count` places after the cursor."""
        return self.tokens[min(self.position + count, len(self.tokens) - 1)]

    def advance(self) -> Token:
        """Take the token at the cursor."""
        token = self.tokens[self.position]
        if token.kind is not TokenKind.END:
            self.position += 1
        return token

    @property
    def at_block_end(self) -> bool:
        """Whether the block ends here."""
        return self.token.kind in (TokenKind.END, TokenKind.REMARK) or self.is_operator(":")

    def is_operator(self, text: str) -> bool:
        """Whether this operator stands here."""
        return self.token.kind is TokenKind.OPERATOR and self.token.value == text

    def is_word(self, *words: str) -> bool:
        """Whether one of these words (upper case) stands here."""
        return self.token.kind is TokenKind.WORD and self.token.value in words

    def accept(self, text: str) -> bool:
        """Take this operator or word if it stands here."""
        if self.token.kind in (TokenKind.OPERATOR, TokenKind.WORD) and self.token.value == text:
            self.position += 1
            return True
        return False

    def expect(self, text: str) -> None:
        """Take this operator or word; anything else is a syntax error."""
        if not self.accept(text):
            raise self.error(SYNTAX_ERROR)

    def error(self, message: Message, detail: object = "") -> StatementError:
        """The error to raise at the cursor."""
        return StatementError(message, self.token.span, detail)

    def error_from(self, start: int, message: Message) -> StatementError:
        """The error to raise for all that was read since the position `start`."""
        first, last = self.tokens[start], self.tokens[max(start, self.position - 1)]
        length = last.column + len(last.text) - first.column
        return StatementError(message, Span(first.span.line, first.column, length))

    # expressions

    def expression(self) -> Expr:
        """One expression, as far as it goes."""
        return self._binary(1)

    def numeric(self) -> Expr:
        """An expression whose value must be a number."""
        start = self.position
        node = self.expression()
        if is_text(node):
            raise self.error_from(start, TYPE_MISMATCH)
        return node

    def _binary(self, lowest: int) -> Expr:
        start = self.position
        if lowest <= NOT_LEVEL and self.accept("NOT"):
            left = self._checked(Op.NOT, self._binary(NOT_LEVEL), start)
        else:
            left = self._operand()
        while (level := self._level_here()) >= lowest:
            op = Op(self.advance().value)
            left = self._joined(op, left, self._right(level), start)
        return left

    def _right(self, level: int) -> Expr:
        """The right operand; NOT is accepted there and takes the rest up to AND or OR."""
        start = self.position
        if self.accept("NOT"):
            return self._checked(Op.NOT, self._binary(NOT_LEVEL), start)
        return self._binary(level + 1)

    def _level_here(self) -> int:
        token = self.token
        if token.kind not in (TokenKind.OPERATOR, TokenKind.WORD):
            return 0
        return BINARY.get(str(token.value), 0)

    def _operand(self) -> Expr:
        """A value with its signs and powers."""
        return self._signed(self._power)

    def _power(self) -> Expr:
        """Powers have one rank, so they go left to right: 2**3**2 is 64."""
        start = self.position
        base = self._primary()
        while self.accept("**"):
            base = self._joined(Op.POWER, base, self._signed(self._primary), start)
        return base

    def _signed(self, inner: Callable[[], Expr]) -> Expr:
        start = self.position
        for sign in (Op.MINUS, Op.PLUS):
            if self.accept(sign.value):
                if self.accept("NOT"):
                    inverse = self._checked(Op.NOT, self._binary(NOT_LEVEL), start)
                    return self._checked(sign, inverse, start)
                return self._checked(sign, self._signed(inner), start)
        return inner()

    def _checked(self, op: Op, operand: Expr, start: int) -> Expr:
        if is_text(operand):
            raise self.error_from(start, TYPE_MISMATCH)
        if op is Op.MINUS and isinstance(operand, Number):
            return Number(-operand.value if operand.value else 0)
        return Unary(op, operand)

    def _joined(self, op: Op, left: Expr, right: Expr, start: int) -> Expr:
        texts = is_text(left) + is_text(right)
        if texts == 1 or (texts == 2 and op is not Op.PLUS and op.value not in _RELATIONS):
            raise self.error_from(start, TYPE_MISMATCH)
        return Binary(op, left, right)

    def _primary(self) -> Expr:
        token = self.token
        if token.kind is TokenKind.NUMBER:
            self.position += 1
            return Number(token.value)  # type: ignore[arg-type]
        if token.kind is TokenKind.STRING:
            self.position += 1
            return String(str(token.value))
        if self.accept("("):
            inner = self.expression()
            self.expect(")")
            return inner
        if token.kind is TokenKind.WORD:
            return self._named()
        raise self.error(SYNTAX_ERROR)

    def _named(self) -> Expr:
        if self.at_variable:
            return self.variable()
        word = str(self.token.value)
        if word in registry.functions:
            return self._application(registry.functions[word])
        raise self.error(SYNTAX_ERROR if word in registry.keywords() else UNDEFINED_SYMBOL)

    def _application(self, function: registry.Function) -> Expr:
        start = self.position
        self.advance()
        arguments: list[Expr] = []
        if self.is_operator("(") or function.fewest:
            self.expect("(")
            arguments.append(self.expression())
            while self.accept(","):
                arguments.append(self.expression())
            self.expect(")")
        if not function.fewest <= len(arguments) <= len(function.takes):
            raise self.error_from(start, SYNTAX_ERROR)
        if not function.accepts([is_text(argument) for argument in arguments]):
            raise self.error_from(start, TYPE_MISMATCH)
        return Apply(function, tuple(arguments))

    # variables

    @property
    def at_variable(self) -> bool:
        """Whether a variable, parameter, flag or alias begins here."""
        token = self.token
        return token.kind is TokenKind.WORD and (
            token.text in self.aliases or token.value in registry.VARIABLES
        )

    def variable(self) -> Expr:
        """The variable, parameter, flag or alias that begins here."""
        token = self.advance()
        if token.text in self.aliases:
            return Alias(token.text, self.aliases[token.text])
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
        self.expect("(")
        index = self.numeric()
        self.expect(")")
        return index

    @property
    def at_object_index(self) -> bool:
        """Whether the number of an object, a literal or `(expr)`, begins here."""
        return self.token.kind is TokenKind.NUMBER or self.is_operator("(")

    def object_index(self) -> Expr:
        """The number of an object or variable: a whole literal or `(expr)`."""
        token = self.token
        if token.kind is TokenKind.NUMBER and isinstance(token.value, int):
            self.position += 1
            return Number(token.value)
        return self._subscript()

    # values after a command word

    @property
    def at_value(self) -> bool:
        """Whether a number, a signed number, a variable or `(expr)` begins here."""
        if self.token.kind is TokenKind.OPERATOR and self.token.value in ("-", "+"):
            following = self.ahead(1)
            return (
                following.kind is TokenKind.NUMBER
                or following.value == "("
                or self._names_number(following)
            )
        return self.at_object_index or self._names_number(self.token)

    def _names_number(self, token: Token) -> bool:
        if token.kind is not TokenKind.WORD:
            return False
        if token.text in self.aliases:
            return not is_text(self.aliases[token.text])
        return token.value in registry.VARIABLES and not str(token.value).startswith("$")

    def value(self) -> Expr:
        """A number, a signed number, a variable or `(expr)`; anything longer needs parentheses."""
        for sign in (Op.MINUS, Op.PLUS):
            if self.accept(sign.value):
                operand = self.value()
                if isinstance(operand, Number):
                    return Number(-operand.value if sign is Op.MINUS else operand.value)
                return Unary(sign, operand)
        if self.token.kind is TokenKind.NUMBER:
            return Number(self.advance().value)  # type: ignore[arg-type]
        if self.accept("("):
            node = self.numeric()
            self.expect(")")
            return node
        if self._names_number(self.token):
            return self.variable()
        raise self.error(SYNTAX_ERROR)
