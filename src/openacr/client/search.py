"""Parameters and flags by some words of their names, the best first."""

import re
from collections.abc import Iterable
from functools import cache
from typing import NamedTuple

from openacr.map import Flag, Parameter, flags, parameters

INSIDE = 3.0  # how much worse a word is inside of another than at its beginning
LENGTH = 0.01  # for a character: of names that fit alike the shortest is first


class _Known(NamedTuple):
    record: Parameter | Flag
    ids: tuple[str, str]  # "p12288", and the number alone
    name: str  # "axis0 current position p12288"


@cache
def _known() -> list[_Known]:
    return [
        _Known(each, (f"{sign}{each.number}", str(each.number)), _name(each, sign))
        for sign, records in _tables()
        for each in records
    ]


def _tables() -> Iterable[tuple[str, Iterable[Parameter] | Iterable[Flag]]]:
    return ("p", parameters().values()), ("bit", flags().values())


def _name(each: Parameter | Flag, sign: str) -> str:
    index = "" if each.index is None else each.index
    return f"{each.object or ''}{index} {each.name} {sign}{each.number}".strip().lower()


def search(text: str, count: int) -> list[Parameter | Flag]:
    """The best of those that have all words: number, beginnings of words, parts of words.

    Where none has, the letters of each word in their order are enough: `actpos` finds the actual
    position. At most `count`; an empty text finds nothing.
    """
    words = text.lower().replace(".", " ").split()
    if not words:
        return []
    found = [
        (_cost(each, words), each) for each in _known() if all(word in each.name for word in words)
    ]
    if not found:
        found = _abbreviated(words)
    found.sort(key=lambda pair: (pair[0], pair[1].record.number))
    return [each.record for _cost, each in found[:count]]


def _cost(each: _Known, words: list[str]) -> float:
    """How badly a name fits that has all words."""
    if len(words) == 1 and words[0] in each.ids:
        return 0.0
    name = f" {each.name}"
    return 1.0 + sum(
        0.0 if f" {word}" in name else INSIDE for word in words
    ) + LENGTH * len(name)  # fmt: skip


def _abbreviated(words: list[str]) -> list[tuple[float, _Known]]:
    patterns = [re.compile(".*?".join(map(re.escape, word))) for word in words]
    found = []
    for each in _known():
        matches = [pattern.search(each.name) for pattern in patterns]
        if all(matches):
            spans = sum(match.end() - match.start() for match in matches if match)
            found.append((spans + LENGTH * len(each.name), each))
    return found
