"""Forms made of others: repeated, one of several, whole commands, the rest of a block."""

from __future__ import annotations

from typing import TYPE_CHECKING

from openacr.basic.language.form import Form
from openacr.basic.language.nodes import Statement
from openacr.lang.lexer import Token, TokenKind
from openacr.messages import SYNTAX_ERROR

if TYPE_CHECKING:
    from openacr.basic.language.parser import Parser
    from openacr.basic.vm.run import Run


class Repeat(Form):
    """A form once or more, with `separator` between; the handler gets a tuple."""

    def __init__(self, each: Form, *, separator: str = "", optional: bool = False) -> None:
        super().__init__(each.name, optional=optional)
        self.each, self.separator = each, separator

    def starts(self, p: Parser) -> bool:
        """Whether the first one begins here."""
        return self.each.starts(p)

    def parse(self, p: Parser) -> tuple[object, ...]:
        """Read as many as there are."""
        found = [self.each.parse(p)]
        while self._goes_on(p):
            if not self.each.starts(p):
                raise p.cursor.error(self.each.missing(p))
            found.append(self.each.parse(p))
        return tuple(found)

    def _goes_on(self, p: Parser) -> bool:
        return p.cursor.accept(self.separator) if self.separator else self.each.starts(p)

    def evaluate(self, run: Run, read: tuple[object, ...] | None) -> tuple[object, ...] | None:
        """All values."""
        return None if read is None else tuple(self.each.evaluate(run, item) for item in read)


class Either(Form):
    """The first of several forms that begins at the cursor; the handler gets its value."""

    def __init__(self, *forms: Form, optional: bool = False) -> None:
        super().__init__("|".join(form.name for form in forms), optional=optional)
        self.forms = forms
        self.names_axes = any(form.names_axes for form in forms)

    def starts(self, p: Parser) -> bool:
        """Whether any of them begins here."""
        return any(form.starts(p) for form in self.forms)

    def parse(self, p: Parser) -> tuple[int, object]:
        """Read the first that fits."""
        for number, form in enumerate(self.forms):
            if form.starts(p):
                return number, form.parse(p)
        raise p.cursor.error(SYNTAX_ERROR)

    def evaluate(self, run: Run, read: tuple[int, object] | None) -> object:
        """The value of the form that was read."""
        return None if read is None else self.forms[read[0]].evaluate(run, read[1])


class Rest(Form):
    """All tokens up to the end of the block; the handler gets them as a tuple."""

    def __init__(self, name: str = "rest") -> None:
        super().__init__(name, optional=True)

    def starts(self, p: Parser) -> bool:
        """Whether anything is left."""
        return not p.cursor.at_block_end

    def parse(self, p: Parser) -> tuple[Token, ...]:
        """Take everything up to the end of the block."""
        found = []
        while not p.cursor.at_block_end:
            found.append(p.cursor.advance())
        return tuple(found)


class Command(Form):
    """A whole command, e.g. the one after `?`; the handler gets the `Statement`."""

    def __init__(self, *, optional: bool = False) -> None:
        super().__init__("command", optional=optional)

    def starts(self, p: Parser) -> bool:
        """Whether a command word stands here."""
        return p.cursor.token.kind is TokenKind.WORD and p.begins_command(p.cursor.token)

    def parse(self, p: Parser) -> Statement:
        """Read the command."""
        return p.statement()
