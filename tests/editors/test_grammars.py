"""The grammars of editors colour what the tables know, as the language server reads it."""

import re
from pathlib import Path
from typing import Any

import pytest
from tests.editors.textmate import SYNTAXES, grammar, parts, rules

from openacr.basic.language import registry
from openacr.basic.language.registry import INDEX
from openacr.cnc.codes.table import DIALECTS
from openacr.editing.controller.marks import marks_of as controller_marks
from openacr.editing.controller.marks import words_of
from openacr.editing.grammars import COMMAND, FUNCTION, LABEL, NUMBER, REMARK, STRING, grammars
from openacr.editing.marks import Kind, Mark
from openacr.editing.part_programs.marks import marks_of as program_marks
from openacr.plc.instructions import BY_WORDS

ROOT = Path(__file__).parents[2]
LANGUAGES = ("acrobasic", "acroplc", "rs274")
NO_NAMES: frozenset[str] = frozenset()
# What Oniguruma and `re` read alike; `(?i)` at the beginning of a rule alone.
GROUP = re.compile(r"\(\?(?!:|=|!|<=|<!)")
SET = re.compile(r"\[\^?(?:\\.|[^\]\\])+\]")
ESCAPE = re.compile(r"\\(?![t.$#?*+()\[\]\\])")


@pytest.mark.parametrize("name", grammars())
def test_a_grammar_is_up_to_date(name: str) -> None:
    assert (SYNTAXES / name).read_text(encoding="utf-8") == grammars()[name], "run `make docs`"


def test_no_grammar_is_left_over() -> None:
    assert {path.name for path in SYNTAXES.iterdir()} == set(grammars())


def captures(rule: dict[str, Any]) -> list[dict[str, Any]]:
    return list(rule.get("captures", {}).values())


@pytest.mark.parametrize("language", LANGUAGES)
def test_rules_use_what_all_engines_read_alike_and_never_match_nothing(language: str) -> None:
    for pattern, rule in rules(language):
        text = rule["match"]
        assert text.startswith("(?i)"), text
        assert not GROUP.search(text[4:]), text
        assert not ESCAPE.search(text.replace("\\\\", "")), text
        outside = SET.sub("x", text)  # of sets of characters
        assert not re.search(r"\{,|[+*?}]\+|\(\?<[=!][^)]*[+*{?]", outside), text
        assert pattern.search("") is None, text
        assert ("name" in rule) != any("name" in each for each in captures(rule)), text
        names = [each["name"] for each in (rule, *captures(rule)) if "name" in each]
        assert all(name.rpartition(".")[2] in LANGUAGES for name in names)
    assert grammar(language)["scopeName"] == f"source.{language}"


TYPED = [
    path
    for row in registry.commands()
    for path in (row.words, *row.synonyms)
    if row.name not in ("LET", "K", "W")  # known by their form
]


@pytest.mark.parametrize("number", ["7", "(LV0)"])
def test_every_command_is_coloured_with_all_its_words(number: str) -> None:
    assert len(TYPED) > 350
    for path in TYPED:
        line = " ".join(number if word == INDEX else word for word in path)
        for text in (line, line.lower()):
            found = parts("acrobasic", text)
            words = [part.text for part in found if part.scope == COMMAND]
            inside = [word for part in words for word in re.findall(r"#?[A-Za-z]+\$?|\?", part)]
            expected = [word for word in path if word != INDEX]
            assert [word.upper() for word in inside] == expected, text


def test_a_number_within_a_command_is_a_number_and_words_may_be_far_apart() -> None:
    assert [(part.text, part.scope) for part in parts("acrobasic", "ENC12  RES\tX")] == [
        ("ENC", COMMAND), ("12", NUMBER), ("RES", COMMAND),
    ]  # fmt: skip
    assert parts("acrobasic", "JOG \t VEL X5")[0].text == "JOG \t VEL"


def test_a_word_of_which_a_command_is_only_a_part_is_no_command() -> None:
    assert parts("acrobasic", "MYACC ACCX $ACC ACC$") == []


@pytest.mark.parametrize("words", BY_WORDS)
def test_every_instruction_of_a_plc_is_a_command(words: tuple[str, ...]) -> None:
    (first, *rest) = parts("acroplc", " ".join(words) + " 12 REM why")
    assert (first.text, first.scope) == (" ".join(words), COMMAND)
    assert [(part.text, part.scope) for part in rest] == [("12", NUMBER), ("REM why", REMARK)]


def test_every_function_operator_variable_and_clause_has_its_colour() -> None:
    for scope, words in (
        (FUNCTION, registry.functions), ("keyword.operator.word", registry.OPERATORS),
        ("variable.other", registry.VARIABLES),
    ):  # fmt: skip
        for word in words:
            assert parts("acrobasic", f"={word}(1)")[1][:2] == (word, scope)
    arguments = {word for row in registry.commands() for word in words_of(row)}
    for word in (arguments | registry.CLAUSES) - registry.VARIABLES - {"REM"}:
        assert parts("acrobasic", f"={word} ")[1].text == word
        assert parts("acrobasic", f"={word} ")[1].scope in (COMMAND, "keyword.other.argument")


@pytest.mark.parametrize("dialect", DIALECTS)
def test_every_code_of_both_dialects_is_a_code_however_it_is_written(dialect: str) -> None:
    table = DIALECTS[dialect].table
    for letter, codes in (("G", table.gcodes), ("M", table.mcodes)):
        for number in codes:
            plain = f"{letter}{number:g}"
            for text in (plain, plain.lower(), f"{letter} 0{number:g}"):
                assert parts("rs274", f"{text}X1")[0][:2] == (text, "keyword.control.code")
    assert [part.scope for part in parts("rs274", "G999")] == ["keyword.other.letter", NUMBER]
    assert parts("rs274", "G1.5")[0].text == "G"


@pytest.mark.parametrize("dialect", DIALECTS)
def test_every_statement_function_and_operator_of_part_programs_has_its_colour(
    dialect: str,
) -> None:
    text = DIALECTS[dialect].grammar
    for scope, words in (
        (COMMAND, text.statements), (FUNCTION, {*text.functions, *text.states, "EXISTS"}),
        ("keyword.operator.word", {word for word in text.operators if word.isalpha()}),
    ):  # fmt: skip
        for word in words:
            assert parts("rs274", f"{word} ")[0][:2] == (word, scope)


SHORT = {
    "code": "keyword.control.code", "letter": "keyword.other.letter", "variable": "variable.other",
    "operator": "keyword.operator", "routine": "entity.name.function", "number": NUMBER,
    "command": COMMAND, "label": LABEL, "remark": REMARK, "string": STRING,
    "file": "string.unquoted.file", "alias": "entity.name.constant",
    "separator": "punctuation.separator.statement",
}  # fmt: skip


@pytest.mark.parametrize(
    ("language", "line", "expected"),
    [
        ("acrobasic", "_Head2 : REM it's", "label _Head2|separator :|remark REM it's"),
        ("acrobasic", "10 GOSUB Head2", "label 10|command GOSUB|label Head2"),
        ("acrobasic", "goto 100", "command goto|label 100"),
        ("acrobasic", "GOSUB _ Head", "command GOSUB|label _ Head"),
        ("acrobasic", "X10", "number 10"),
        ("acrobasic", "X&B1010", "number &B1010"),
        ("acrobasic", 'PRINT "a""b REM" \' c', "command PRINT|string \"a\"\"b REM\"|remark ' c"),
        ("acrobasic", "? &HFF", "command ?|number &HFF"),
        ("acrobasic", "P12288=1.5E-3", "variable P12288|operator =|number 1.5E-3"),
        ("acrobasic", "#DEFINE Lamp BIT32", "command #DEFINE|alias Lamp|variable BIT32"),
        ("acrobasic", "REMOTE", ""),
        ("rs274", "N10 G1 X-1.5 (a;b)", "label N10|code G1|letter X|number -1.5|remark (a;b)"),
        ("rs274", "/N20 M30;end", "label N20|code M30|remark ;end"),
        ("rs274", "X(P1+2)", "letter X|variable P1|operator +|number 2"),
        ("rs274", "G4 P2", "code G4|letter P|number 2"),
        ("rs274", "o<ring> sub (why)", "routine o<ring>|command sub|remark (why)"),
        ("rs274", "N5 o9 if [1]", "label N5|routine o9|command if|number 1"),
        ("rs274", "G0 Z#<safe> (up)", "code G0|letter Z|variable #<safe>|remark (up)"),
        ("rs274", "X[#1] (up)", "letter X|variable #1|remark (up)"),
        ("rs274", "(up)", "remark (up)"),
        ("rs274", "IF P1=2 THEN GOTO 20",
         "command IF|variable P1|operator =|number 2|command THEN|command GOTO|label 20"),
        ("rs274", "$I CYCLES.TXT", "command $I|file CYCLES.TXT"),
        ("rs274", "%", ""),
    ],
)  # fmt: skip
def test_a_line_has_these_colours(language: str, line: str, expected: str) -> None:
    pairs = [each.split(" ", 1) for each in expected.split("|") if each]
    found = [(part.text, part.scope) for part in parts(language, line)]
    assert found == [(text, SHORT[name]) for name, text in pairs]


# the examples: the same as the language server reads

SCOPES = {
    Kind.COMMAND: COMMAND, Kind.FUNCTION: FUNCTION, Kind.STRING: "string.",
    Kind.REMARK: REMARK, Kind.LABEL: LABEL, Kind.CODE: "keyword.control.code",
    Kind.ROUTINE: "entity.name.function", Kind.CELL: "variable.other",
    Kind.PARAMETER: "variable.other", Kind.NAMED: "variable.other",
}  # fmt: skip


def different(language: str, line: str, marks: tuple[Mark, ...]) -> list[str]:
    """Parts that the server reads otherwise than the grammar colours them."""
    found = [(part.column, part.column + len(part.text), part) for part in parts(language, line)]
    scopes = {at: part.scope for start, end, part in found for at in range(start, end)}
    return [
        f"{line!r}: {line[mark.start : mark.end]!r} {mark.kind.name} {scopes.get(mark.start)}"
        for mark in marks
        if mark.kind in SCOPES and not scopes.get(mark.start, "").startswith(SCOPES[mark.kind])
    ]


def lines_of(*patterns: str) -> list[str]:
    files = sorted(path for pattern in patterns for path in ROOT.glob(pattern))
    return [line for path in files for line in path.read_text("latin-1").splitlines()]


def test_programs_of_the_examples_have_the_colours_that_the_server_finds() -> None:
    lines = lines_of("examples/*/prog*.8k", "examples/*/setup.8k")
    assert len(lines) > 300
    for line in lines:
        marks = controller_marks(line, NO_NAMES, NO_NAMES, is_plc=False)
        assert different("acrobasic", line, marks) == []


def test_plcs_of_the_examples_have_the_colours_that_the_server_finds() -> None:
    lines = lines_of("examples/*/plc*.8k")
    assert len(lines) > 10
    for line in lines:
        marks = controller_marks(line, NO_NAMES, NO_NAMES, is_plc=True)
        assert different("acroplc", line, marks) == []


@pytest.mark.parametrize(
    ("dialect", "name"), [("acromill", "bolt_circle.nc"), ("rs274ngc", "flange_ngc.nc")]
)
def test_part_programs_have_the_colours_that_the_server_finds(dialect: str, name: str) -> None:
    for line in lines_of(f"parts/{name}"):
        assert different("rs274", line, program_marks(line, dialect)) == []
