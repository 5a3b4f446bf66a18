"""The words of cases about what is loaded beside part programs: library parts, ballscrew tables."""

from __future__ import annotations

import re

from openacr.conform.form import (
    ANSWERS,
    BLOCK,
    Step,
    compare,
    compare_messages,
    compare_text,
    messages_taken,
    word,
)
from openacr.conform.stage import Stage
from openacr.errors import UserError

_SIZE = re.compile(r"P(\d+)=(.+)")
_D_NUMBER = re.compile(r"D(\d+)")
_PLACE = re.compile(r"table(?::(\d+))?: (.*)")


@word("library part TEXT", ANSWERS)
def library_part(stage: Stage, step: Step, text: str) -> None:
    """Load a library part: TRIANGLE P200=3 D1; sizes in their units, below: why it is refused."""
    name, *words = text.split()
    sizes = {int(found[1]): float(found[2]) for found in map(_SIZE.fullmatch, words) if found}
    numbers = [int(found[1]) for found in map(_D_NUMBER.fullmatch, words) if found]
    if len(sizes) + len(numbers) != len(words):
        raise UserError(f"{text}: expected NAME P200=3 ... D1")
    try:
        stage.mill.load_part(name, sizes, sum(numbers))
    except UserError as error:
        compare(step, str(error).splitlines())
    else:
        compare(step, [])


@word("ballscrew NAME:", BLOCK)
def ballscrew(stage: Stage, step: Step, letter: str) -> None:
    """Load a table from its file; `# E: text` at a line that is wrong, and nothing is loaded."""
    found = []
    try:
        stage.mill.load_table(letter, "\n".join(messages_taken(step)) + "\n")
    except UserError as error:
        place = _PLACE.fullmatch(str(error))
        if place is None:
            raise
        found.append((int(place[1] or len(step.below)), False, place[2]))
    compare_messages(step, found)


@word("ballscrew NAME measured, home at VALUE:", BLOCK)
def measured(stage: Stage, step: Step, letter: str, home_u: float) -> None:
    """Make a table of measurements, positions and what was measured there; `makes:` compares it."""
    lines = "".join(f"{line.text}\n" for line in step.below)
    stage.mill.made = stage.mill.table_of(letter, lines, home_u)


@word("makes:", BLOCK)
def makes(stage: Stage, step: Step) -> None:
    """The file of the table that the measurements make."""
    compare_text(step, "", stage.mill.made.splitlines())
