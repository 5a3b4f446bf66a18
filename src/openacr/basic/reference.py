"""Write the reference pages from the registry: `python -m openacr.basic.reference FOLDER EXAMPLES`.

One page per group of the manual, one for operators and functions, one for parameters and
flags, one for messages. Examples of commands are taken from the controller files of the
second folder. Nothing on a page is written by hand.
"""

from __future__ import annotations

import re
import sys
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping
from inspect import cleandoc
from pathlib import Path

from openacr.basic import commands as _commands  # noqa: F401 - registers the commands
from openacr.basic.commands import strings as _strings  # noqa: F401 - registers the functions
from openacr.basic.language import registry
from openacr.basic.language.expressions import BINARY, NOT_LEVEL, SIGN_LEVEL
from openacr.basic.language.lister import Lister
from openacr.basic.language.loader import file_lines
from openacr.basic.language.nodes import Block, LineTree, Statement
from openacr.basic.language.parser import Parser
from openacr.basic.language.registry import INDEX, Command, Level
from openacr.basic.language.scope import Scope
from openacr.basic.language.written import call, levels, limits, reports, syntax
from openacr.errors import CardError
from openacr.lang.lexer import Token, tokens
from openacr.map import flags, parameters
from openacr.map.lookup import Flag, Parameter
from openacr.messages import MESSAGES
from openacr.models import MODELS

_ANY_AXES = frozenset(("X", "Y", "Z", "A", "B", "C"))
MADE_BY = "Written by `make docs` from the rows of the registry; do not edit."


def pages(examples: Mapping[str, str]) -> dict[str, str]:
    """All pages by file name; `examples` are lines by the name of the command they show."""
    found = {f"{slug(group)}.md": _group(group, rows, examples) for group, rows in groups().items()}
    found["functions.md"] = _functions()
    found["parameters.md"] = _map_page()
    found["messages.md"] = _messages()
    found["README.md"] = _contents()
    return {name: text.rstrip() + "\n" for name, text in found.items()}


def groups() -> dict[str, list[Command]]:
    """The commands of each group, both in alphabetical order."""
    found: dict[str, list[Command]] = defaultdict(list)
    for row in registry.commands():
        found[row.group].append(row)
    return dict(sorted(found.items()))


def slug(group: str) -> str:
    """The file name of a group."""
    return re.sub(r"[^a-z0-9]+", "-", group.lower()).strip("-")


def title(row: Command) -> str:
    """The heading of a command."""
    return " ".join("n" if word == INDEX else word for word in row.words)


# commands


def _group(group: str, rows: Iterable[Command], examples: Mapping[str, str]) -> str:
    parts = [f"# {group}", MADE_BY]
    for row in rows:
        parts += [f"## {title(row)}", cleandoc(row.handler.__doc__ or "")]
        parts.append("\n".join(facts(row, examples.get(row.name, ""))))
    return "\n\n".join(parts)


def facts(row: Command, example: str = "") -> Iterator[str]:
    """What the reference says of a command below its description, a list item each."""
    yield f"* Written: `{syntax(row)}`"
    for name in row.synonyms:
        yield f"* Also: `{' '.join(name)}`"
    yield f"* Level: {levels(row)}"
    if found := [text for form in row.grammar if (text := limits(form))]:
        yield f"* Limits: {', '.join(found)}"
    if row.units:
        yield f"* Unit: {row.units}"
    if row.default:
        yield f"* Default: {row.default}"
    if reports(row):
        yield "* Without its value it reports what is set"
    if row.move:
        yield "* Part of the coordinated move of its block"
    if row.saved:
        yield "* Kept by ESAVE"
    if without := [model.name for model in MODELS.values() if row.needs & model.lacks]:
        yield f"* Not on the {', '.join(without)}: `Not supported`"
    if row.is_extension:
        yield "* An extension of openacr: real cards refuse it"
    elif row.ref:
        yield f"* Manual: {row.ref}"
    if example:
        yield f"* Example: `{example}`"


# operators and functions


def _functions() -> str:
    rows = [*BINARY.items(), ("NOT", NOT_LEVEL), ("-x", SIGN_LEVEL), ("**", SIGN_LEVEL + 1)]
    binding = defaultdict(list)
    for operator, level in rows:
        binding[level].append(f"`{operator}`")
    parts = ["# Operators and functions", MADE_BY, "## Operators", _PRECEDENCE]
    parts.append(_table(("binds", "operators"), _numbered(binding)))
    parts.append("## Functions")
    functions = sorted(registry.functions.values(), key=lambda function: function.name)
    written = ((f"`{call(function)}`", function.summary) for function in functions)
    parts.append(_table(("function", "gives"), written))
    return "\n\n".join(parts)


_PRECEDENCE = "The tightest first; equal ones, powers too, go from left to right."


def _numbered(binding: Mapping[int, list[str]]) -> Iterator[tuple[str, str]]:
    for place, level in enumerate(sorted(binding, reverse=True), start=1):
        yield str(place), " ".join(binding[level])


# the map and the messages


def _map_page() -> str:
    parts = ["# Parameters and flags", MADE_BY, _LOOKUP, "## Parameters"]
    parts.append(_map_table(parameters().values(), "P"))
    parts += ["## Flags", _map_table(flags().values(), "BIT")]
    return "\n\n".join(parts)


_LOOKUP = "`openacr param NUMBER` and `openacr flag NUMBER` say everything about a single one."


def _map_table(rows: Iterable[Parameter | Flag], prefix: str) -> str:
    found: dict[str, list[int]] = defaultdict(list)
    for row in rows:
        found[f"{row.section} | {row.object}"].append(row.number)
    lines = (
        (name, f"{prefix}{min(numbers)} to {prefix}{max(numbers)}", str(len(numbers)))
        for name, numbers in found.items()
    )
    return _table(("section | object", "from", "how many"), lines)


def _messages() -> str:
    shown = (message for message in MESSAGES.values() if message.text)
    rows = ((str(message.number), f"`{message.text.format('...')}`") for message in shown)
    return "\n\n".join(["# Messages", MADE_BY, _table(("number", "text"), rows)])


def _contents() -> str:
    parts = ["# Reference", MADE_BY, "## Commands by group"]
    for group, rows in groups().items():
        words = ", ".join(title(row) for row in rows)
        parts.append(f"[{group}]({slug(group)}.md): {words}")
    parts += ["## Everything else", _OTHERS]
    return "\n\n".join(parts)


_OTHERS = """\
* [Operators and functions](functions.md)
* [Parameters and flags](parameters.md)
* [Messages](messages.md)
* [PLC programs](plc.md)"""


def _table(head: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> str:
    lines = [" | ".join(head), " | ".join("---" for name in head for _ in name.split(" | "))]
    lines += [" | ".join(row) for row in rows]
    return "\n".join(f"| {line} |" for line in lines)


# examples


def examples_of(folder: Path) -> dict[str, str]:
    """The shortest statement for each command in the controller files of a folder."""
    found: dict[str, str] = {}
    for file in sorted(folder.glob("**/*.8k")):
        for line in file_lines(file.read_text()):
            for name, text in _statements(line.text):
                if name not in found or (len(text), text) < (len(found[name]), found[name]):
                    found[name] = text
    return found


def _statements(text: str) -> Iterator[tuple[str, str]]:
    """The commands of a line as they are listed; a line that needs an alias gives none."""
    try:
        found = tokens(text)
        line = Parser(found, Scope(Level.PROG, True, _ANY_AXES)).line()
    except CardError:
        return
    if len(statements := _all(line)) == 1:
        yield statements[0].command.name, _listed(found, line)


def _all(line: LineTree) -> list[Statement]:
    return [statement for block in line.blocks for statement in _of(block)]


def _of(block: Block) -> Iterator[Statement]:
    for item in block:
        yield from (item,) if isinstance(item, Statement) else item.parts


def _listed(found: list[Token], line: LineTree) -> str:
    shown = [token for token in found if line.remark is None or token.text.upper() != "REM"]
    return Lister().line(shown).strip(" :")


def main(arguments: list[str], say: Callable[[str], None] = print) -> None:
    """Write all pages into a folder, examples taken from another."""
    folder, examples = Path(arguments[0]), Path(arguments[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in pages(examples_of(examples)).items():
        (folder / name).write_text(text)
        say(str(folder / name))


if __name__ == "__main__":
    main(sys.argv[1:])
