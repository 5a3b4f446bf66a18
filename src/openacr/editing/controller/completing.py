"""Proposals and signatures in controller files."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from functools import cache

from openacr.basic.language import registry
from openacr.basic.language.registry import INDEX, Command, Function, Level
from openacr.basic.language.written import form, function_at
from openacr.editing.completions import (
    Completion,
    Item,
    Signature,
    by_name,
    by_number,
)
from openacr.editing.controller.marks import names_flags, tokens_before, words_of
from openacr.editing.controller.texts import written
from openacr.editing.document import Place
from openacr.editing.marks import Kind, Mark
from openacr.lang.lexer import Token, TokenKind
from openacr.plc.instructions import BY_WORDS

_JUMP = re.compile(r"(?<![A-Za-z])GO(?:TO|SUB)[ \t]+_?[ \t]*(\w*)$", re.IGNORECASE)
_NUMBERED = re.compile(r"(?<![A-Za-z$])(P|BIT)[ \t]*\(?[ \t]*(\d+)$", re.IGNORECASE)
_DIGITS = re.compile(r"(?<![\w.])(\d+)$")
_WORD = re.compile(r"[#$]?[A-Za-z]*$")
_NAMES_IN_WORD = re.compile(r"[A-Za-z]\w*$")
_ANYWHERE = Level.PROG | Level.PLC | Level.SYS | Level.SYS_BY_OBJECT


def complete(
    text: str,
    place: Place,
    marks: Iterable[Mark],
    level: Level,
    named: Iterable[Item],
    labels: Iterable[str],
) -> Completion:
    """Proposals at a place of a line; `named` are those the project names itself."""
    before = text[: place.column]
    if _is_text(before, marks):
        return Completion.of(place, "", [])
    if jump := _JUMP.search(before):
        items = [Item(label, Kind.LABEL, "label") for label in sorted(set(labels))]
        return Completion.of(place, jump[1], items)
    found = tokens_before(text, place.column)
    row = _row_before(marks, place.column)
    if numbered := _NUMBERED.search(before):
        kind = Kind.PARAMETER if numbered[1].upper() == "P" else Kind.FLAG
        items = by_number(numbered[2], kind)
        return Completion.of(place, numbered[2], items, is_whole=False)
    if digits := _DIGITS.search(before):
        is_flag = names_flags(row) if isinstance(row, Command) else level is Level.PLC
        items = by_number(digits[1], Kind.FLAG) if is_flag else []
        return Completion.of(place, digits[1], items, is_whole=False)
    word = _WORD.search(before)
    typed = word[0] if word else ""
    if found and typed and found[-1].kind is TokenKind.WORD:
        found = found[:-1]
    if typed.startswith("#") and found and found[-1].value == "#":
        found = found[:-1]
    items = [*_words(found, row, level), *named, *by_name(typed)]
    return Completion.of(place, typed, items, is_whole=len(typed) > 2)


def _is_text(before: str, marks: Iterable[Mark]) -> bool:
    """Whether the cursor is within a string or a remark."""
    for mark in marks:
        if mark.kind is Kind.REMARK and mark.start < len(before):
            return True
        if mark.kind is Kind.STRING and mark.start < len(before) < mark.end:
            return True
    return before.count('"') % 2 == 1


def _row_before(marks: Iterable[Mark], column: int) -> object:
    rows = [mark.row for mark in marks if mark.kind is Kind.COMMAND and mark.end < column + 1]
    return rows[-1] if rows else None


def _words(found: list[Token], row: object, level: Level) -> Iterator[Item]:
    if level is Level.PLC:
        for instruction in dict.fromkeys(BY_WORDS.values()):
            yield Item(instruction.name, Kind.COMMAND, instruction.summary, row=instruction)
        return
    yield from _next_words(found)
    if isinstance(row, Command):
        yield from (Item(word, Kind.KEYWORD, row.name) for word in sorted(words_of(row)))
    yield from _first_words(level)
    yield from _of_expressions()


def _next_words(found: list[Token]) -> Iterator[Item]:
    """The words that may follow the words of a command that has just begun."""
    for start in range(len(found)):
        node = registry.root
        for token in found[start:]:
            key = INDEX if token.kind is TokenKind.NUMBER else str(token.value)
            if key not in node.children:
                break
            node = node.children[key]
        else:
            for word, child in sorted(node.children.items()):
                if word != INDEX:
                    yield _word_item(word, child)
            return


def _word_item(word: str, node: registry.Node) -> Item:
    if node.command is not None:
        return Item(word, Kind.COMMAND, node.command.summary, row=node.command)
    first = next(_commands_below(node), None)
    more = ", ".join(sorted(child for child in node.children if child != INDEX)[:6])
    return Item(word, Kind.COMMAND, f"{word} {more}..." if more else word, row=first)


def _commands_below(node: registry.Node) -> Iterator[Command]:
    if node.command is not None:
        yield node.command
    for child in node.children.values():
        yield from _commands_below(child)


@cache
def _first_words(level: Level) -> tuple[Item, ...]:
    """The words that begin a command at a level."""
    wanted = level | (Level.SYS_BY_OBJECT if level is Level.SYS else level)
    return tuple(
        _word_item(word, node)
        for word, node in sorted(registry.root.children.items())
        if any(row.levels & wanted for row in _commands_below(node))
    )


@cache
def _of_expressions() -> tuple[Item, ...]:
    functions = [
        Item(name, Kind.FUNCTION, row.summary, row=row)
        for name, row in sorted(registry.functions.items())
    ]
    words = sorted(registry.OPERATORS | registry.CLAUSES | registry.VARIABLES)
    return (*functions, *(Item(word, Kind.KEYWORD) for word in words))


def signature(text: str, column: int, marks: Iterable[Mark]) -> Signature | None:
    """How the function or command around a column is written."""
    found = tokens_before(text, column)
    if found and (function := _function_around(found)):
        return _of_function(function, found)
    row = _row_before(marks, column)
    if row is None:
        return None
    parts = tuple(map(form, row.grammar)) if isinstance(row, Command) else ()
    label = written(row)  # type: ignore[arg-type]
    return Signature(label, row, tuple(part for part in parts if part in label))


def _function_around(found: list[Token]) -> Function | None:
    """The function in whose arguments the end of these tokens lies."""
    last = found[-1]
    depth = sum((token.value == "(") - (token.value == ")") for token in found)
    return function_at(found, last.column + len(last.text)) if depth > 0 else None


def _of_function(row: Function, found: list[Token]) -> Signature:
    label = written(row)
    inside = label.partition("(")[2].removesuffix(")")
    depth = active = 0
    for token in reversed(found):
        depth += (token.value == ")") - (token.value == "(")
        if depth < 0:
            break
        active += token.value == "," and depth == 0
    return Signature(label, row, tuple(inside.split(", ")) if inside else (), active)
