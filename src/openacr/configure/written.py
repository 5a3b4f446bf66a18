"""Answers as the text of their file; what is as by default is left out."""

import json
from collections.abc import Iterator

from msgspec import NODEFAULT, Struct, structs

from openacr.configure.answers import Answers


def written(answers: Answers) -> str:
    """The text of configure.toml that `parse_answers` reads as these answers."""
    return "\n".join(_lines(answers)) + "\n"


def _lines(answers: Answers) -> Iterator[str]:
    yield "[card]"
    yield f"model = {_value(answers.card.model)}"
    yield from (pair for pair in _pairs(answers.card) if not pair.startswith("model "))
    for name, tables in (("axis", answers.axis), ("master", answers.master)):
        for table in tables:
            yield from ("", f"[[{name}]]", *_pairs(table))


def _pairs(table: Struct) -> Iterator[str]:
    for field in structs.fields(table):
        value = getattr(table, field.name)
        if field.default is NODEFAULT or value != field.default:
            yield f"{field.name} = {_value(value)}"


def _value(value: object) -> str:
    if isinstance(value, Struct):
        return "{ " + ", ".join(_pairs(value)) + " }"
    if isinstance(value, tuple | list):
        return "[" + ", ".join(map(_value, value)) + "]"
    if isinstance(value, float):
        short = f"{value:g}"
        return short if float(short) == value else repr(value)
    return json.dumps(value, ensure_ascii=False)  # the same in TOML for numbers, words and texts
