"""The tree of one line, as the card parses it."""

from openacr.basic.language.nodes import LineTree
from openacr.basic.language.parser import Parser
from openacr.basic.language.scope import Scope
from openacr.lang.lexer import tokens


def parse_line(text: str | bytes, scope: Scope, line: int = 1) -> LineTree:
    """CardError with what is wrong and where (`span`)."""
    return Parser(tokens(text, line), scope).line()
