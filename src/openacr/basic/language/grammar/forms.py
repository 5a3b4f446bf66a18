"""Forms of single arguments: numbers, strings, words, groups.

A form reads one argument (`parse`, when the line is read) and later turns what it read
into the value the handler gets (`evaluate`, when the command is executed).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from openacr.basic.language.form import Form
from openacr.basic.language.nodes import Apply, Expr, Number, Unary, is_text, resolved
from openacr.errors import CardError
from openacr.lang.lexer import TokenKind
from openacr.messages import INVALID_ARGUMENT, SYNTAX_ERROR

if TYPE_CHECKING:
    from openacr.basic.language.parser import Parser
    from openacr.basic.vm.run import Run


class Num(Form):
    """A number: literal, signed literal, variable or `(expr)`; the handler gets a float."""

    def starts(self, p: Parser) -> bool:
        """Whether a value begins here."""
        return p.expressions.at_value

    def parse(self, p: Parser) -> Expr:
        """Read the value."""
        return p.expressions.value()

    def evaluate(self, run: Run, read: Expr | None) -> float | None:
        """The number."""
        return None if read is None else run.value(read)


class Int(Num):
    """A whole number within limits; others are `Invalid argument`. The handler gets an int."""

    def __init__(
        self,
        name: str = "",
        low: int = -2147483648,
        high: int = 2147483647,
        *,
        optional: bool = False,
    ) -> None:
        super().__init__(name, optional=optional)
        self.low, self.high = low, high

    def evaluate(self, run: Run, read: Expr | None) -> int | None:
        """The number, truncated toward zero."""
        if read is None:
            return None
        value = run.integer(read)
        if not self.low <= value <= self.high:
            raise CardError(INVALID_ARGUMENT)
        return value


class Str(Form):
    """A string expression; the handler gets a str."""

    def starts(self, p: Parser) -> bool:
        """Whether a string begins here."""
        token = p.cursor.token
        if token.kind is TokenKind.WORD and token.text in p.scope.aliases:
            return is_text(p.scope.aliases[token.text])
        return token.kind is TokenKind.STRING or (
            token.kind is TokenKind.WORD
            and (token.text.startswith("$") or token.text.endswith("$"))
        )

    def parse(self, p: Parser) -> Expr:
        """Read the expression."""
        return p.expressions.expression()

    def evaluate(self, run: Run, read: Expr | None) -> str | None:
        """The text."""
        return None if read is None else run.text(read)


class Expression(Form):
    """A whole expression, number or string; the handler gets the tree and evaluates it."""

    def starts(self, p: Parser) -> bool:
        """Whether anything is left in the block."""
        return not p.cursor.at_block_end

    def parse(self, p: Parser) -> Expr:
        """Read the expression."""
        return p.expressions.expression()


class Condition(Form):
    """The condition of IF and WHILE: an expression that begins with a parenthesis."""

    def starts(self, p: Parser) -> bool:
        """Whether a parenthesis stands here."""
        return p.cursor.is_operator("(")

    def parse(self, p: Parser) -> Expr:
        """Read the expression."""
        return p.expressions.numeric()


class Lvalue(Form):
    """A variable that can be assigned; the handler gets the tree (see `Run.assign`)."""

    def starts(self, p: Parser) -> bool:
        """Whether a variable begins here."""
        return p.expressions.at_variable

    def parse(self, p: Parser) -> Expr:
        """Read the variable; an alias of a constant is no variable."""
        node = p.expressions.variable()
        if isinstance(resolved(node), Number | Apply | Unary):
            raise p.cursor.error(SYNTAX_ERROR)
        return node


class Word(Form):
    """One of some words; the handler gets it in upper case."""

    def __init__(self, *words: str, optional: bool = False) -> None:
        super().__init__("|".join(words), optional=optional)
        self.words = frozenset(words)

    def starts(self, p: Parser) -> bool:
        """Whether one of the words stands here."""
        return p.cursor.is_word(*self.words)

    def parse(self, p: Parser) -> str:
        """Take the word."""
        return str(p.cursor.advance().value)


class Mark(Form):
    """A fixed word or operator: AS, #, a comma. The handler gets True for an optional one."""

    def __init__(self, text: str, *, optional: bool = False) -> None:
        super().__init__(text, optional=optional)
        self.silent = not optional

    def starts(self, p: Parser) -> bool:
        """Whether it stands here."""
        return p.cursor.is_operator(self.name) or p.cursor.is_word(self.name)

    def parse(self, p: Parser) -> bool:
        """Take it."""
        p.cursor.advance()
        return True


class Group(Form):
    """`(a, b, ...)`: between `fewest` and `most` numbers; the handler gets a tuple of floats."""

    def __init__(
        self, *names: str, fewest: int | None = None, single: bool = False, optional: bool = False
    ) -> None:
        super().__init__(",".join(names), optional=optional)
        self.most = len(names)
        self.fewest = self.most if fewest is None else fewest
        self.single = single  # one value may stand without parentheses

    def starts(self, p: Parser) -> bool:
        """Whether a parenthesis (or a single value) begins here."""
        return p.cursor.is_operator("(") or (self.single and p.expressions.at_value)

    def parse(self, p: Parser) -> tuple[Expr, ...]:
        """Read the values."""
        if not p.cursor.is_operator("("):
            return (p.expressions.value(),)
        p.cursor.advance()
        found = [p.expressions.numeric()]
        while p.cursor.accept(","):
            found.append(p.expressions.numeric())
        p.cursor.expect(")")
        allowed = self.fewest <= len(found) <= self.most or (self.single and len(found) == 1)
        if not allowed:
            raise p.cursor.error(SYNTAX_ERROR)
        return tuple(found)

    def evaluate(self, run: Run, read: tuple[Expr, ...] | None) -> tuple[float, ...] | None:
        """The numbers."""
        return None if read is None else tuple(run.value(node) for node in read)


class Pair(Group):
    """`v` (plus v, minus -v) or `(plus, minus)`; the handler gets both."""

    def __init__(self, *, optional: bool = False) -> None:
        super().__init__("plus", "minus", single=True, optional=optional)

    def evaluate(self, run: Run, read: tuple[Expr, ...] | None) -> tuple[float, ...] | None:
        """Plus and minus value."""
        values = super().evaluate(run, read)
        if values is None or len(values) == 2:
            return values
        return values[0], -values[0]
