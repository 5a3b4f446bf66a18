"""Forms of flags and parameters by name or number."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec import Struct

from openacr.basic.language.form import Form
from openacr.basic.language.grammar.values import BitState, SignedParameter
from openacr.basic.language.nodes import Expr, resolved
from openacr.basic.language.nodes import Flag as FlagNode
from openacr.basic.language.nodes import Parameter as ParameterNode
from openacr.lang.lexer import TokenKind
from openacr.messages import SYNTAX_ERROR

if TYPE_CHECKING:
    from openacr.basic.language.parser import Parser
    from openacr.basic.vm.run import Run


class BitItem(Struct, frozen=True):
    """A flag number as written."""

    number: Expr
    clear: bool


class Bit(Form):
    """`n`, `BITn`, `BIT(expr)`, `(expr)` or an alias, with `signed` also negated.

    The handler gets a `BitState`.
    """

    def __init__(self, name: str = "bit", *, signed: bool = False, optional: bool = False) -> None:
        super().__init__(name, optional=optional)
        self.signed = signed

    def starts(self, p: Parser) -> bool:
        """Whether a flag begins here."""
        return p.expressions.at_value and (self.signed or not p.cursor.is_operator("-"))

    def parse(self, p: Parser) -> BitItem:
        """Read the flag; its number may be given by any variable."""
        clear = self.signed and p.cursor.accept("-")
        if not clear:
            p.cursor.accept("+")
        node = p.expressions.value()
        target = resolved(node)
        return BitItem(target.index if isinstance(target, FlagNode) else node, clear)

    def evaluate(self, run: Run, read: BitItem | None) -> BitState | None:
        """The flag; a negative number that was computed also means the clear state."""
        if read is None:
            return None
        number = run.integer(read.number)
        if number < 0 and self.signed:
            return BitState(-number, not read.clear)
        return BitState(number, read.clear)


class Bits(Form):
    """One or more flags; the handler gets a tuple of `BitState`."""

    def __init__(self) -> None:
        super().__init__("bit")
        self.each = Bit()

    def starts(self, p: Parser) -> bool:
        """Whether a flag begins here."""
        return self.each.starts(p)

    def parse(self, p: Parser) -> tuple[BitItem, ...]:
        """Read as many flags as there are."""
        found = [self.each.parse(p)]
        while self.each.starts(p):
            found.append(self.each.parse(p))
        return tuple(found)

    def evaluate(self, run: Run, read: tuple[BitItem, ...]) -> tuple[BitState | None, ...]:
        """The flags."""
        return tuple(self.each.evaluate(run, item) for item in read)


class ParameterName(Form):
    """`Pnnnn` (an alias too), with `signed` also `-Pnnnn`; the handler gets `SignedParameter`."""

    def __init__(self, name: str = "Pn", *, signed: bool = False, optional: bool = False) -> None:
        super().__init__(name, optional=optional)
        self.signed = signed

    def starts(self, p: Parser) -> bool:
        """Whether a parameter begins here."""
        has_sign = p.cursor.is_operator("+") or (self.signed and p.cursor.is_operator("-"))
        token = p.cursor.ahead(1) if has_sign else p.cursor.token
        return token.kind is TokenKind.WORD and (
            isinstance(p.scope.aliases.get(token.text), ParameterNode) or token.value == "P"
        )

    def parse(self, p: Parser) -> tuple[Expr, bool]:
        """Read the parameter."""
        negative = p.cursor.accept("-")
        if not negative:
            p.cursor.accept("+")
        node = resolved(p.expressions.variable())
        if not isinstance(node, ParameterNode):
            raise p.cursor.error(SYNTAX_ERROR)
        return node.index, negative

    def evaluate(self, run: Run, read: tuple[Expr, bool] | None) -> SignedParameter | None:
        """The parameter by number."""
        return None if read is None else SignedParameter(run.integer(read[0]), read[1])
