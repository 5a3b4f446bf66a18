"""What happened in a short part of a history, to the tick: found by living through it again."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from openacr.controller.controller import Controller
from openacr.timeline.course import Course

PROGRAMS = range(16)
_ALL_PROGRAMS = 0xFFFF
DIGITS = 6


@dataclass(slots=True)
class _Lines:
    """The lines of a program as they were executed; of near ones the last, which may stay."""

    near_tk: int
    count: int = 0
    slices: list[tuple[int, int]] = field(default_factory=list)  # tick and line

    def note(self, tick: int, line: int) -> None:
        self.count += 1
        if self.slices and tick - self.slices[-1][0] < self.near_tk:
            tick, _left = self.slices.pop()
        self.slices.append((tick, line))


def details(course: Course, first_tk: int, last_tk: int, columns: int) -> dict[str, Any]:
    """Curves of the axes that moved with their distances, and the executed lines of programs.

    A curve has the place at the begin of each column, and the lowest and highest velocity in it
    (units, units/s); a slice of a program its tick and line. Lines within less than a column are
    counted, the last of them is a slice.
    """
    near_tk = max(0, (last_tk - first_tk) // columns)
    found = {program: _Lines(near_tk) for program in PROGRAMS}
    moments = course.moments([first_tk, last_tk])
    card = next(moments)

    def passes(program: int, line: int) -> bool:
        found[program].note(card.lived_tk, line)
        return False

    card.record(1)
    card.announce_lines(_ALL_PROGRAMS, passes)
    next(moments)
    return {
        "axes": _axes(card, columns),
        "programs": [
            {
                "number": number,
                "lines": lines.count,
                "slices": lines.slices,
                "texts": _texts(card, number, {line for _, line in lines.slices}),
            }
            for number, lines in found.items()
            if lines.count
        ],
    }


def _axes(card: Controller, columns: int) -> list[dict[str, Any]]:
    found = []
    for number, axis in enumerate(card.trace().axes):
        places, speeds = axis.commanded_u, axis.velocity_ups
        if not len(places) or float(np.ptp(places)) == 0.0:
            continue
        begins = np.linspace(0, len(places), min(columns, len(places)), endpoint=False).astype(int)
        found.append(
            {
                "number": number,
                "distance": float(np.abs(np.diff(places)).sum()),
                "places": places[begins].tolist(),
                "low": np.minimum.reduceat(speeds, begins).tolist(),
                "high": np.maximum.reduceat(speeds, begins).tolist(),
            }
        )
    return found


def _texts(card: Controller, program: int, lines: set[int]) -> dict[int, str]:
    """The texts of lines of a program, as it is at the end."""
    stored = card.system.programs.lines(program)
    return {each.number: each.text.strip() for each in stored if each.number in lines}


def change_of(
    course: Course, word: int, mask: int, first_tk: int, last_tk: int, *, is_last: bool
) -> int | None:
    """The tick of the first or last change of a flag after one tick, up to another."""
    moments = course.moments([first_tk, last_tk])
    card = next(moments)
    card.log_changes([(word, mask)])
    next(moments)
    ticks = card.take_changes().ticks
    return int(ticks[-1 if is_last else 0]) if len(ticks) else None


def line_of(
    course: Course, program: int, line: int, first_tk: int, last_tk: int, *, is_last: bool
) -> int | None:
    """The tick in which a program begins a line for the first or last time, likewise."""
    found: list[int] = []
    moments = course.moments([first_tk, last_tk])
    card = next(moments)

    def passes(_program: int, number: int) -> bool:
        if number == line and (is_last or not found):
            found[:] = [card.lived_tk]
        return False

    card.announce_lines(1 << program, passes)
    next(moments)
    return found[0] if found else None
