"""Where two branches of a history differ first: outputs, positions, lines of programs."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from openacr.controller.controller import Controller
from openacr.timeline.branch import Branch
from openacr.timeline.course import Course

ALL_PROGRAMS = 0xFFFF
_BITS = 32
Pair = tuple[float | None, float | None]


class Difference(NamedTuple):
    """The first difference of a kind: in which tick, of what, and the values on both branches.

    Of the kind `output`, `number` is the place of the word and the bit in what was asked for,
    32 bits a word; of `setpoint` and `actual` the axis, the values its positions in units; of
    `line` the program, the values the lines that it was at (None: none was begun).
    """

    kind: str
    tick: int
    number: int
    values: Pair


class Seen(NamedTuple):
    """What is compared beside positions: places of words of outputs, a bit for each program."""

    words: Sequence[int]
    programs: int = ALL_PROGRAMS


def apart_tk(one: Branch, other: Branch) -> int | None:
    """The tick of the first input that two branches do not share; None where they share all.

    A card does the same after the same inputs: before that tick nothing differs.
    """
    known = max(one.forgotten, other.forgotten)
    own, others = (branch.entries[known - branch.forgotten :] for branch in (one, other))
    shared = min(len(own), len(others))
    place = next((n for n in range(shared) if own[n] != others[n]), shared)
    ticks = [entries[place].tick for entries in (own, others) if place < len(entries)]
    return min(ticks, default=None)


class _Lived:
    """What is seen of a branch while it is lived through."""

    def __init__(self, course: Course, first_tk: int, last_tk: int, seen: Seen) -> None:
        self.lines: list[tuple[int, int, int]] = []  # tick, program, line
        moments = course.moments([first_tk, last_tk])
        card = next(moments)
        card.log_changes([(word, -1) for word in seen.words])
        self.outputs = [card.logged()]  # at the end of each tick that is in `ticks`
        self.ticks = [first_tk]
        card.record(1)
        card.announce_lines(seen.programs, lambda program, line: self._passes(card, program, line))
        next(moments)
        for tick, word, value in zip(*card.take_changes(), strict=True):
            if tick != self.ticks[-1]:
                self.ticks.append(int(tick))
                self.outputs.append(list(self.outputs[-1]))
            self.outputs[-1][word] = int(value)
        axes = card.trace().axes
        self.setpoints = np.array([axis.commanded_u for axis in axes])
        self.actual = np.array([axis.actual_u for axis in axes])

    def _passes(self, card: Controller, program: int, line: int) -> bool:
        self.lines.append((card.lived_tk, program, line))
        return False

    def words_at(self, tick: int) -> list[int]:
        return self.outputs[bisect_right(self.ticks, tick) - 1]

    def line_at(self, tick: int, program: int) -> int | None:
        own = (line for at, of, line in reversed(self.lines) if of == program and at <= tick)
        return next(own, None)


def first_differences(
    one: Course, other: Course, first_tk: int, last_tk: int, seen: Seen
) -> list[Difference]:
    """The first difference of each kind from the end of one tick to that of another, in order.

    Both branches are lived through.
    """
    own, others = (_Lived(each, first_tk, last_tk, seen) for each in (one, other))
    found = [
        _of_outputs(own, others),
        _of_places("setpoint", own.setpoints, others.setpoints, first_tk),
        _of_places("actual", own.actual, others.actual, first_tk),
        _of_lines(own, others),
    ]
    return sorted((each for each in found if each is not None), key=lambda each: each.tick)


def _of_outputs(own: _Lived, others: _Lived) -> Difference | None:
    for tick in sorted({*own.ticks, *others.ticks}):
        for word, (a, b) in enumerate(zip(own.words_at(tick), others.words_at(tick), strict=True)):
            if a != b:
                bit = ((a ^ b) & -(a ^ b)).bit_length() - 1
                return Difference("output", tick, _BITS * word + bit, (a >> bit & 1, b >> bit & 1))
    return None


def _of_places(
    kind: str, own: NDArray[np.float64], others: NDArray[np.float64], first_tk: int
) -> Difference | None:
    differ = own != others
    if not differ.any():
        return None
    row = int(differ.any(axis=0).argmax())
    axis = int(differ[:, row].argmax())
    values = float(own[axis, row]), float(others[axis, row])
    return Difference(kind, first_tk + 1 + row, axis, values)


def _of_lines(own: _Lived, others: _Lived) -> Difference | None:
    pairs: Any = zip(own.lines, others.lines, strict=False)
    shared = min(len(own.lines), len(others.lines))
    place = next((n for n, (a, b) in enumerate(pairs) if a != b), shared)
    next_ones = [each.lines[place] for each in (own, others) if place < len(each.lines)]
    if not next_ones:
        return None
    tick, program, _line = min(next_ones)
    first, second = (
        each.lines[place][2]
        if each.lines[place : place + 1] and each.lines[place][:2] == (tick, program)
        else each.line_at(tick, program)
        for each in (own, others)
    )
    return Difference("line", tick, program, (first, second))
