"""Find parameters of the store by number or by words of their name."""

import re
from bisect import bisect_left
from collections.abc import Iterator
from difflib import get_close_matches
from functools import cache, lru_cache

from openacr.errors import MapError
from openacr.sysvar.schema import CARD_PARAMETERS, CARD_VARIABLES, FIRST_SYSTEM, Parameter, Tab
from openacr.sysvar.tabs import CELLS, TAB_CELLS, TABS

_NUMBER = re.compile(r"[Pp]?\s*(\d{1,9})")
_WORD = re.compile(r"[a-z0-9]+|[+%-]")
AXIS_LETTERS = "XYZABCUV"
_AXIS_WORDS = frozenset(("axis", *AXIS_LETTERS.lower()))
LISTED = 5
LONGEST_NAME = 60
NEAR = 0.7  # share of the letters of a name that have to match
_LAST_TAB = len(TABS) - 1
Named = tuple[Parameter, list[str]]


def _tab_of(number: int) -> Tab:
    if number < FIRST_SYSTEM:
        return CELLS.tab
    return TABS[min((number - FIRST_SYSTEM) // TAB_CELLS, _LAST_TAB)]


@lru_cache(maxsize=1 << 14)  # every cell
def parameter(number: int) -> Parameter | None:
    """The parameter of a cell number; None if there is no such cell."""
    return _tab_of(number).parameter(number)


def known(number: int) -> Parameter:
    """The parameter of a cell number; MapError if there is no such cell."""
    found = parameter(number)
    if found is None:
        raise MapError(f"P{number} is not in the store{_where(number)}")
    return found


def _where(number: int) -> str:
    if number in CARD_VARIABLES:
        return ": it is a variable of the card"
    if number in CARD_PARAMETERS:
        return ": it is a parameter of the card"
    numbers = _numbers()
    place = bisect_left(numbers, number)
    near = [f"P{each}" for each in numbers[max(0, place - 1) : place + 1]]
    return f" (the nearest: {' and '.join(near)})"


@lru_cache(maxsize=1)
def _numbers() -> list[int]:
    return [each.number for each in parameters()]


@cache
def parameters() -> tuple[Parameter, ...]:
    """All cells of the store in the order of their numbers."""
    return tuple(each for tab in (CELLS.tab, *TABS) for each in in_tab(tab))


@cache
def wired() -> tuple[Parameter, ...]:
    """The cells that name an input or output of the card, in the order of their numbers."""
    return tuple(each for each in parameters() if each.row.wire)


def tab_named(text: str) -> Tab | None:
    """The tab of that name, in upper or lower case."""
    wanted = text.strip().upper()
    return next((tab for tab in (*TABS, CELLS.tab) if tab.name == wanted), None)


def in_tab(tab: Tab) -> list[Parameter]:
    """The parameters of a tab in the order of their numbers."""
    return [known(tab.base + offset) for offset in sorted(tab.cells)]


def find(text: str) -> list[Parameter]:
    """The parameters a number, a tab or words of a name match; MapError if none does."""
    number = _NUMBER.fullmatch(text.strip())
    if number:
        return [known(int(number[1]))]
    tab = tab_named(text)
    found = in_tab(tab) if tab else _named(_words(text))
    if not found:
        raise MapError(f"no parameter of the store is named {text.strip()!r}{_meant(text)}")
    return found


def _meant(text: str) -> str:
    """The most similar name or tab, as a question; empty where none is similar."""
    names = {"".join(words): members[0][0].name for words, members in _names() if members} | {
        tab.name.lower(): tab.name for tab in TABS
    }
    telling = [word for word in _words(text[:LONGEST_NAME]) if word not in _AXIS_WORDS]
    near = get_close_matches("".join(telling), names, n=1, cutoff=NEAR)
    return f": did you mean {names[near[0]]!r}?" if near else ""


def _names() -> Iterator[tuple[list[str], list[Named]]]:
    """The words of the name of each row, without those of axes, and its parameters."""
    for _, members in _catalogue():
        yield [word for word in members[0][1] if word not in _AXIS_WORDS], members


def tab_like(text: str) -> str:
    """The most similar tab, as a question; empty where none is similar."""
    near = get_close_matches(text.strip().upper(), [tab.name for tab in TABS], n=1)
    return f"did you mean {near[0]}?" if near else ""


def one(text: str) -> Parameter:
    """The only parameter a text matches; MapError if there are several."""
    found = find(text)
    if len(found) > 1:
        several = ", ".join(str(parameter) for parameter in found[:LISTED])
        more = f" and {len(found) - LISTED} more" if len(found) > LISTED else ""
        raise MapError(f"{text.strip()!r} can be {several}{more}: give its number, or its axis")
    return found[0]


def _words(text: str) -> list[str]:
    return _WORD.findall(text.lower())


@lru_cache(maxsize=1)
def _catalogue() -> tuple[tuple[list[str], list[Named]], ...]:
    """The words of the name and tab of each row, and its parameters with their own words."""
    rows: dict[tuple[str, int], tuple[list[str], list[Named]]] = {}
    for found in parameters():
        words = [*_words(found.row.name), *_words(found.tab)]
        row = rows.setdefault((found.tab, found.row.k), (words, []))
        row[1].append((found, _words(found.name)))
    return tuple(rows.values())


def _named(words: list[str]) -> list[Parameter]:
    """The parameters whose name is exactly these words, else those that contain all of them."""
    partly = []
    exactly = []
    telling = [word for word in words if word not in _AXIS_WORDS and not word.isdigit()]
    for own_words, members in _catalogue():
        if not all(any(_begins(own, word) for own in own_words) for word in telling):
            continue
        for found, own in members:
            rest = _without(words, own)
            if rest is not None and (not rest or _names_axis(rest, found)):
                exactly.append(found)
            elif _has_all(words, found, own):
                partly.append(found)
    return exactly or partly


def _without(words: list[str], own: list[str]) -> list[str] | None:
    """The words left after removing the whole name, in its order; None if it is not there."""
    size = len(own)
    for start in range(len(words) - size + 1):
        if words[start : start + size] == own:
            return words[:start] + words[start + size :]
    return None


def _names_axis(words: list[str], found: Parameter) -> bool:
    """Whether the words left name the axis (X, axis X, axis 0), the tab, or both."""
    tab = _words(found.tab)
    rest = [word for word in words if word != "axis" and word not in tab]
    axis = [] if found.axis is None else [str(found.axis), AXIS_LETTERS[found.axis].lower()]
    return all(word in axis for word in rest)


def _has_all(words: list[str], found: Parameter, own: list[str]) -> bool:
    axis = [] if found.axis is None else ["axis", str(found.axis), AXIS_LETTERS[found.axis].lower()]
    beside = {*_words(found.tab), *axis}
    return all(word in beside or any(_begins(part, word) for part in own) for word in words)


def _begins(part: str, word: str) -> bool:
    return part == word if word.isdigit() else part.startswith(word)
