"""Plans of blocks as numbers for `blocks_cy`, made once for each shape of lines."""

from __future__ import annotations

from typing import TYPE_CHECKING

from openacr.cnc.canonical import AXIS_LETTERS
from openacr.cnc.codes.fast import Does, Sets
from openacr.cnc.interpreter import blocks_cy as core

if TYPE_CHECKING:
    from collections.abc import Iterable

    from openacr.cnc.codes.block_plan import Plan
    from openacr.cnc.codes.table import Code

FIELDS = ("motion", "plane", "distance", "centres", "unit", "return_level", "path")
ARC_WORDS = "IJKR"
STRAIGHT = 1
_KNOWN_WORDS = frozenset(AXIS_LETTERS + ARC_WORDS + "F")
_NO_MORE = 0, 0


def fast_plan(plan: Plan, acts: Iterable[Code]) -> list[int] | None:
    """The numbers of a plan; None where a code or a word of it has no fast form."""
    if plan.is_computed or not _KNOWN_WORDS.issuperset(plan.words):
        return None
    steps: list[int] = []
    is_plain, is_alone = not any(letter in plan.words for letter in ARC_WORDS), False
    for code in acts:
        form = code.fast
        match form:
            case Does.NOTHING:
                is_plain = is_plain and code.letter == "MACRO"
            case Does.TAKES_FEED:
                steps += (core.STEP_FEED, *_NO_MORE)
            case Does.MOVES:
                steps += (core.STEP_MOVE, *_NO_MORE)
            case Sets(field, value, alone) if field in FIELDS:
                number = int(code.number) if value is None else value
                kind = core.STEP_UNIT if field == "unit" else core.STEP_SET
                steps += (kind, FIELDS.index(field), number)
                is_plain = is_plain and (field, number) == ("motion", STRAIGHT)
                is_alone = is_alone or alone
            case _:
                return None
    axes = sum(1 << axis for axis, _ in plan.axes)
    words = sum(1 << k for k, letter in enumerate(ARC_WORDS) if letter in plan.words)
    return [axes, words, is_plain, is_alone, len(steps) // 3, *steps]
