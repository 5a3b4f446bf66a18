"""A text beside what a card holds: lines that mean the same are opposite each other."""

from collections.abc import Sequence
from difflib import SequenceMatcher
from typing import Any, NamedTuple

from openacr.client.listing import Meaning, is_free_form, meaning
from openacr.client.stored import ListedLine
from openacr.panel.work.desk import State
from openacr.panel.work.text_questions import Entered, desk, stored_lines


class Row(NamedTuple):
    """A line of the text (from 1) and one of the card (by its number); 0: there is none."""

    line: int
    text: str
    number: int
    listed: str
    is_same: bool


def compared(state: State, listings: dict[str, Sequence[ListedLine]]) -> dict[str, Any]:
    """The programs of a text beside their listings; `stale` where the text has to be sent whole."""
    opened = desk().at(state)
    if opened is None:
        return {"stale": True}
    entered = stored_lines(opened)
    programs = []
    for name, listed in listings.items():
        rows = side_by_side(entered.get(name, []), listed)
        is_equal = all(row.is_same for row in rows)
        programs.append({"name": name, "rows": rows, "is_equal": is_equal})
    return {"version": opened.version, "answer": programs}


def side_by_side(entered: Sequence[Entered], listed: Sequence[ListedLine]) -> list[Row]:
    """Rows of what is entered and what is listed, aligned by meaning; numbers count where typed."""
    texts = [each.text for each in entered] or [each.text for each in listed]
    has_numbers = bool(texts) and not is_free_form(texts[0])
    left = [_meaning(each, has_numbers=has_numbers) for each in entered]
    right = [_meaning(each, has_numbers=has_numbers) for each in listed]
    rows: list[Row] = []
    for kind, a, a_end, b, b_end in SequenceMatcher(None, left, right, False).get_opcodes():
        for n in range(max(a_end - a, b_end - b)):
            mine = entered[a + n] if a + n < a_end else Entered(0, 0, "")
            its = listed[b + n] if b + n < b_end else ListedLine(0, "")
            rows.append(Row(mine.line, mine.text, its.number, its.text, kind == "equal"))
    return rows


def _meaning(line: Entered | ListedLine, *, has_numbers: bool) -> Meaning:
    return (line.number if has_numbers else 0, *meaning(line.text))
