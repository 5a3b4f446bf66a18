"""All files of a configuration by their names in a project."""

import re
from collections.abc import Iterable, Iterator

from openacr.basic import commands as _registered  # noqa: F401 - fills the registry
from openacr.basic.language.nodes import Move
from openacr.basic.language.parser import Parser
from openacr.basic.language.registry import Level
from openacr.basic.language.scope import Scope
from openacr.configure.answers import Answers
from openacr.configure.setup_code import FIRST_PLC, WATCH_PROGRAM, setup_code
from openacr.configure.watch_code import data_code, plc_codes, watch_code
from openacr.lang.lexer import tokens
from openacr.map import flag, parameter

DATA_PROGRAM = 15
SETUP = "setup.8k"
_FLAG = re.compile(r"(SET|CLR) BIT(\d+)")
_PARAMETER = re.compile(r"P(\d+)=")
_LEVEL = re.compile(r"SYS|PROG\d+")
_STATES = {"SET": "on", "CLR": "off"}


def code_files(answers: Answers, source: str, *, is_explained: bool = False) -> dict[str, str]:
    """The controller files made of the answers, whose text is `source`.

    With `is_explained` every line of the set-up file has a remark that says what it does.
    """
    plcs = [] if answers.card.watches_limits else plc_codes(answers)
    setup = setup_code(answers, len(plcs))
    files = {SETUP: explained(setup) if is_explained else setup}
    for place, rungs in enumerate(plcs):
        files[f"plc{FIRST_PLC + place}.8k"] = iter(rungs)
    if plcs:
        files[f"prog{WATCH_PROGRAM}.8k"] = watch_code(answers, source)
    else:
        files[f"prog{DATA_PROGRAM}.8k"] = data_code(source)
    return {name: "\n".join(lines).rstrip() + "\n" for name, lines in files.items()}


def explained(lines: Iterable[str]) -> Iterator[str]:
    """Yield the lines, each with a remark made of the summary of what it sets; remarks stay."""
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
