"""A remark on every line of configuration code, made of the summaries of commands and flags."""

import re
from collections.abc import Iterable, Iterator

from openacr.basic import commands as _registered  # noqa: F401 - fills the registry
from openacr.basic.language.nodes import Move
from openacr.basic.language.parser import Parser
from openacr.basic.language.registry import Level
from openacr.basic.language.scope import Scope
from openacr.lang.lexer import tokens
from openacr.map import flag, parameter

_FLAG = re.compile(r"(SET|CLR) BIT(\d+)")
_PARAMETER = re.compile(r"P(\d+)=")
_LEVEL = re.compile(r"SYS|PROG\d+")
_STATES = {"SET": "on", "CLR": "off"}


def explained(lines: Iterable[str]) -> Iterator[str]:
    """Yield the lines with a remark at the end of each; remarks and empty lines stay."""
    level = Level.SYS
    for line in lines:
        if not line or line.startswith("REM"):
            yield line
            continue
        yield f"{line} : REM {_meaning(line, level)}"
        if _LEVEL.fullmatch(line):
            level = Level.SYS if line == "SYS" else Level.PROG


def _meaning(line: str, level: Level) -> str:
    if switched := _FLAG.fullmatch(line):
        found = flag(int(switched[2]))
        return f"{found.name} {_STATES[switched[1]]}: {found.description}".rstrip(".: ")
    if stored := _PARAMETER.match(line):
        held = parameter(int(stored[1]))
        return f"{held.name}: {held.description}".rstrip(".: ")
    (statement,) = Parser(tokens(line, 1), Scope(level)).line().blocks[0]
    if isinstance(statement, Move):
        raise TypeError(f"{line}: configuration code moves nothing")
    return statement.command.summary.rstrip(".")
