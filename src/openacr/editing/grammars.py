"""Write the TextMate grammars of editors: `python -m openacr.editing.grammars FOLDER`.

Their words are those of the registry of commands, of the instructions of a PLC and of the tables
of codes. The expressions use only what Oniguruma (the engine of such editors) and `re` share, and
read one line at a time: what depends on other lines is coloured by the language server.
"""

import json
import re
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from openacr.basic import commands as _registered  # noqa: F401 - fills the registry
from openacr.basic.language import registry
from openacr.basic.language.registry import INDEX
from openacr.cnc.codes import dialects as _dialects  # noqa: F401 - fills the table
from openacr.cnc.codes.table import DIALECTS
from openacr.editing.controller.marks import JUMPS, words_of
from openacr.editing.part_programs.marks import ROUTINE_WORDS
from openacr.plc.instructions import BY_WORDS

Rule = dict[str, Any]

MADE_BY = "Written by `make docs` from the tables of `openacr`; do not edit."
BLANK = r"[ \t]*"
_BEFORE, _AFTER = "(?<![A-Za-z$])", "(?![A-Za-z$])"  # a word of AcroBASIC is letters alone
_NUMBER = r"(?:[0-9]+\.?[0-9]*|\.[0-9]+)"
_INDEX = r"[0-9]+|\([^()]*\)"  # the number of an object within the words of a command
_REMARK = r"\([^)]*\)?"

COMMAND, ARGUMENT = "keyword.control.command", "keyword.other.argument"
FUNCTION, OPERATOR = "support.function", "keyword.operator"
LABEL, REMARK = "entity.name.label", "comment.line"
NUMBER, STRING = "constant.numeric", "string.quoted.double"
VARIABLE, NAME, AXIS = "variable.other", "entity.name.constant", "support.variable.axis"
CODE, LETTER = "keyword.control.code", "keyword.other.letter"
ROUTINE, FILE = "entity.name.function", "string.unquoted.file"


def grammars() -> dict[str, str]:
    """The texts of all grammars by file name."""
    found = {
        "acrobasic": _grammar("AcroBASIC", "acrobasic", _acrobasic()),
        "acroplc": _grammar("PLC of an ACR controller", "acroplc", _acroplc()),
        "rs274": _grammar("Part program (RS-274)", "rs274", _part_program()),
    }
    return {
        f"{name}.tmLanguage.json": json.dumps(grammar, indent=2) + "\n"
        for name, grammar in found.items()
    }


def _grammar(title: str, name: str, rules: Iterable[Rule]) -> Rule:
    scope = f"source.{name}"
    patterns = [_within(rule, name) for rule in rules]
    return {"comment": MADE_BY, "name": title, "scopeName": scope, "patterns": patterns}


def _within(rule: Rule, language: str) -> Rule:
    """The rule with the language at the end of all scopes, as themes expect it."""
    if "include" in rule:
        return rule
    found = dict(rule)
    if "name" in rule:
        found["name"] = f"{rule['name']}.{language}"
    if "captures" in rule:
        found["captures"] = {
            number: {
                key: f"{value}.{language}"
                if key == "name"
                else [_within(each, language) for each in value]
                for key, value in capture.items()
            }
            for number, capture in rule["captures"].items()
        }
    return found


def _rule(scope: str, pattern: str, *captures: str) -> Rule:
    """A rule for the whole match (`scope`, may be empty) and its groups, without regard to case."""
    found: Rule = {"name": scope} if scope else {}
    found["match"] = f"(?i){pattern}"
    if captures:
        found["captures"] = {
            str(place): {"name": each} for place, each in enumerate(captures, start=1)
        }
    return found


def _any_of(words: Iterable[str]) -> str:
    """One of the patterns or words, the longest first: `JOG VEL` before `JOG`."""
    return f"(?:{'|'.join(sorted(words, key=lambda word: (-len(word), word)))})"


def _words(words: Iterable[str]) -> str:
    """One of the words, neither preceded nor followed by a letter."""
    return f"{_BEFORE}{_any_of(map(re.escape, words))}{_AFTER}"


# controllers


def _acrobasic() -> Iterator[Rule]:
    arguments = {word for row in registry.commands() for word in words_of(row)}
    yield _rule(REMARK, rf"{_BEFORE}REM{_AFTER}.*")
    yield _rule(REMARK, "'.*")
    yield _rule(STRING, '"(?:[^"]|"")*"?')
    yield _rule(
        "",
        rf"{_BEFORE}({_any_of(JUMPS)}){_AFTER}"
        rf"(?:{BLANK}([A-Z][A-Z0-9]*|[0-9]+))?",
        COMMAND,
        LABEL,
    )
    yield _rule("", rf"^{BLANK}([0-9]+)", LABEL)
    yield _rule(LABEL, rf"_{BLANK}[A-Z0-9]+")
    yield _rule("", r"(#DEFINE)(?![A-Za-z$])(?:[ \t]+([^ \t]+))?", COMMAND, NAME)
    yield _rule(VARIABLE, rf"{_words(registry.VARIABLES)}(?:{BLANK}[0-9]+)?")
    yield _rule(FUNCTION, rf"{_words(registry.functions)}(?={BLANK}\()")
    yield _commands()
    yield _rule(FUNCTION, _words(registry.functions))
    yield _rule(f"{OPERATOR}.word", _words(registry.OPERATORS))
    yield _rule(AXIS, rf"{_BEFORE}AXIS{BLANK}[0-9]+")
    yield _rule(ARGUMENT, _words(arguments | registry.CLAUSES))
    yield _rule(NUMBER, r"&H[0-9A-F]{1,8}|&B[01]{1,32}")
    yield _rule(NUMBER, rf"{_NUMBER}(?:E[-+]?[0-9]+)?")
    yield _rule(COMMAND, r"\?")
    yield _rule(OPERATOR, r"\*\*|<<|>>|<>|<=|>=|[-+*/=<>]")
    yield _rule("punctuation.separator.statement", ":")


def _commands() -> Rule:
    """All commands with all their words; the numbers of objects within them are numbers."""
    written = {_written(path) for path in _typed(registry.root) if path[0].isalpha()}
    rule = _rule(COMMAND, f"{_BEFORE}{_any_of(written)}")
    return rule | {"captures": {"0": {"patterns": [_rule(NUMBER, _INDEX)]}}}


def _typed(node: registry.Node, before: tuple[str, ...] = ()) -> Iterator[tuple[str, ...]]:
    """The words of all commands that begin with words; assignments are known by their form."""
    if node.command is not None:
        yield before
    for word, child in node.children.items():
        yield from _typed(child, (*before, word))


def _written(path: tuple[str, ...]) -> str:
    """The pattern of the words of a command."""
    found = ""
    for before, word in zip(("", *path), path, strict=False):
        if word == INDEX:
            found += f"{BLANK}(?:{_INDEX}){BLANK}"
        else:
            found += ("" if before in ("", INDEX) else r"[ \t]+") + re.escape(word)
    return found + ("" if path[-1] == INDEX else _AFTER)


def _acroplc() -> Iterator[Rule]:
    instructions = {r"[ \t]+".join(words) for words in BY_WORDS}
    yield _rule(COMMAND, rf"{_BEFORE}{_any_of(instructions)}{_AFTER}")
    yield {"include": "source.acrobasic"}


# part programs


def _part_program() -> Iterator[Rule]:
    dialects = DIALECTS.values()
    texts = [dialect.grammar for dialect in dialects]
    statements = {word for text in texts for word in text.statements if word.isalpha()}
    functions = {word for text in texts for word in (*text.functions, *text.states)}
    operators = {word for text in texts for word in text.operators if word.isalpha()}
    yield _rule(REMARK, ";.*")
    yield _rule(STRING, '"[^"]*"?')
    yield _rule("", r"(\$I)[ \t]*([^;(]*)", COMMAND, FILE)
    yield _rule(
        "",
        rf"^{BLANK}(N{BLANK}[0-9]+)?{BLANK}(O{BLANK}(?:<[^<>]*>|[0-9]+))"
        rf"(?:{BLANK}({_any_of(ROUTINE_WORDS)})(?![A-Z]))?(?:{BLANK}({_REMARK}))?",
        LABEL, ROUTINE, COMMAND, REMARK,
    )  # fmt: skip
    yield _rule("", rf"^{BLANK}/?{BLANK}(N{BLANK}[0-9]+)", LABEL)
    yield _rule("", rf"(#{BLANK}<[^<>]*>?)(?:{BLANK}({_REMARK}))?", VARIABLE, REMARK)
    yield _rule(VARIABLE, rf"#{BLANK}[0-9]+")
    yield _rule(VARIABLE, rf"P{BLANK}[0-9]+(?={BLANK}[-=+*/<>)])|(?<=[(=+*<>,-])P{BLANK}[0-9]+")
    yield _rule("", rf"(?:^|(?<=[0-9).%\]])){BLANK}({_REMARK})", REMARK)
    yield _rule(CODE, f"G{_codes(each.table.gcodes for each in dialects)}")
    yield _rule(CODE, f"M{_codes(each.table.mcodes for each in dialects)}")
    yield _rule("", rf"({_words(('GOTO', 'GOSUB'))}){BLANK}([0-9]+)", COMMAND, LABEL)
    yield _rule(COMMAND, _words(statements | {"THEN"}))
    yield _rule(FUNCTION, _words(functions | {"EXISTS"}))
    yield _rule(f"{OPERATOR}.word", _words(operators | {"NOT"}))
    yield _rule("", rf"([A-Z@^]){BLANK}([-+]?{BLANK}{_NUMBER})", LETTER, NUMBER)
    yield _rule(LETTER, "[A-Z@^]")
    yield _rule(NUMBER, _NUMBER)
    yield _rule(OPERATOR, r"\*\*|<>|<=|>=|[-+*/=<>]")


def _codes(tables: Iterable[Iterable[float]]) -> str:
    """The number of a code of any dialect: `1`, `01` and `1.0` are the same."""
    numbers = {f"{number:g}" for table in tables for number in table}
    return rf"{BLANK}0*{_any_of(map(re.escape, numbers))}(?:\.0*)?(?![0-9.])"


if __name__ == "__main__":
    for _name, _text in grammars().items():
        (Path(sys.argv[1]) / _name).write_text(_text, encoding="utf-8", newline="\n")
