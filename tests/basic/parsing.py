"""The tree of one line, as the card parses it."""

from openacr.basic.nodes import Line
from openacr.basic.parser import Parser
from openacr.basic.scope import Scope
from openacr.lang.lexer import tokens


def parse_line(text: str | bytes, scope: Scope, line: int = 1) -> Line:
    """CardError with what is wrong and where (`span`)."""
    return Parser(tokens(text, line), scope).line()
