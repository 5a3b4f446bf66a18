"""Forms of objects with a number: ENC0, PROG3, ALL."""

from __future__ import annotations

from typing import TYPE_CHECKING

from openacr.basic.language.form import Form
from openacr.basic.language.grammar.values import ObjectRef
from openacr.basic.language.nodes import Expr, Number
from openacr.lang.lexer import TokenKind

if TYPE_CHECKING:
    from openacr.basic.language.parser import Parser
    from openacr.basic.vm.run import Run


class Object(Form):
    """A word with a number, e.g. `Object("ENC", "ADC")` for `ENC0`; with `bare` a number alone.

    `singles` are words without number. The handler gets an `ObjectRef`.
    """

    def __init__(
        self, *words: str, singles: tuple[str, ...] = (), bare: str = "", optional: bool = False
    ) -> None:
        super().__init__("|".join((*words, *singles)), optional=optional)
        self.words = frozenset(words)
        self.singles = frozenset(singles)
        self.bare = bare  # the word meant by a number without word

    def starts(self, p: Parser) -> bool:
        """Whether one of the words (or a number) stands here."""
        if p.cursor.is_word(*self.singles) or (self.bare and p.expressions.at_object_index):
            return True
        return p.cursor.is_word(*self.words) and (
            p.cursor.ahead(1).kind is TokenKind.NUMBER or p.cursor.ahead(1).value == "("
        )

    def parse(self, p: Parser) -> tuple[str, Expr]:
        """Read word and number."""
        if self.bare and p.expressions.at_object_index:
            return self.bare, p.expressions.object_index()
        word = str(p.cursor.advance().value)
        p.names_object = True
        return word, (Number(-1) if word in self.singles else p.expressions.object_index())

    def evaluate(self, run: Run, read: tuple[str, Expr] | None) -> ObjectRef | None:
        """The object by number."""
        return None if read is None else ObjectRef(read[0], run.integer(read[1]))


class Target(Object):
    """`PROGn`, `PLCn` or `ALL`: what RUN, HALT and their kin act on."""

    def __init__(self) -> None:
        super().__init__("PROG", "PLC", singles=("ALL",), optional=True)


class Source(Object):
    """A source of pulses: NONE, CLK, ENCn, AXISn, ..., Pn or a bare parameter number."""

    WORDS = ("ENC", "STEPPER", "AXIS", "RATCH", "LIMIT", "ADC", "P")

    def __init__(self, *, optional: bool = False) -> None:
        super().__init__(*self.WORDS, singles=("NONE", "CLK", "CLOCK"), bare="P", optional=optional)
