"""Colour a line by a TextMate grammar of single-line rules, as editors do.

The leftmost match counts, of two at one place that of the earlier rule.
"""

import json
import re
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

FOLDER = Path(__file__).parents[2] / "editors" / "vscode"
SYNTAXES = FOLDER / "syntaxes"


class Part(NamedTuple):
    """A part of a line with its scope, without the language at its end."""

    text: str
    scope: str
    column: int


@cache
def grammar(language: str) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(
        (SYNTAXES / f"{language}.tmLanguage.json").read_text(encoding="utf-8")
    )
    return found


@cache
def rules(language: str) -> tuple[tuple[re.Pattern[str], dict[str, Any]], ...]:
    """The rules in their order, with those of included grammars."""
    found: list[tuple[re.Pattern[str], dict[str, Any]]] = []
    for rule in grammar(language)["patterns"]:
        if "include" in rule:
            found += rules(rule["include"].removeprefix("source."))
        else:
            found.append((re.compile(rule["match"]), rule))
    return tuple(found)


def parts(language: str, line: str) -> list[Part]:
    """The coloured parts of a line from left to right."""
    found: list[Part] = []
    at = 0
    while at < len(line):
        hits = [(hit, rule) for each, rule in rules(language) if (hit := each.search(line, at))]
        if not hits:
            break
        hit, rule = min(hits, key=lambda pair: pair[0].start())
        assert hit.end() > at, (line, rule)
        found += _parts_of(hit, rule)
        at = hit.end()
    return found


def _parts_of(hit: re.Match[str], rule: dict[str, Any]) -> list[Part]:
    captures = rule.get("captures", {})
    inner = captures.get("0", {}).get("patterns")
    if inner:
        return _around(hit, rule["name"], inner[0])
    if "name" in rule:
        return [Part(hit[0], _plain(rule["name"]), hit.start())]
    return [
        Part(hit[place], _plain(each["name"]), hit.start(place))
        for place, each in ((int(key), value) for key, value in captures.items())
        if hit[place]
    ]


def _around(hit: re.Match[str], name: str, inner: dict[str, Any]) -> list[Part]:
    """The parts of a match before, in and after those that have a rule of their own."""
    found, at = [], 0
    for each in [*re.finditer(inner["match"], hit[0]), None]:
        start = each.start() if each else len(hit[0])
        text = hit[0][at:start]
        if text.strip():
            blanks = len(text) - len(text.lstrip())
            found.append(Part(text.strip(), _plain(name), hit.start() + at + blanks))
        if each:
            found.append(Part(each[0], _plain(inner["name"]), hit.start() + start))
            at = each.end()
    return found


def _plain(scope: str) -> str:
    return scope.rpartition(".")[0]
