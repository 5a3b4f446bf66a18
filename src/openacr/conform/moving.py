"""Cases that move a motor, or set what they put back: what they may type, and on which axis.

Such a case says with `moves: 1 units at 2 units/s` how far axis 0 goes from where it is, and how
fast, and with `changes: P12348, BIT128` what it sets. It jogs by lengths that are written in it
(JOG INC), so that a card whose host is gone ends its motion by itself within that travel. Its
`machine:` is that of a virtual card; on one in use it is what is there.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from openacr.conform.form import NUMBER, Case, Line, Reach, Step
from openacr.map.block import BITS_PER_WORD, FLAG_WORD_BASE
from openacr.map.rows import axes
from openacr.map.words import af1, af2, af3, af4, af5, af6

AXIS_WORDS = tuple(each.word for each in (af1, af2, af3, af4, af5, af6))  # of flags, by axis
JOG_ACTIVE = "BIT792"
SETTINGS = {"VEL": "P12348", "ACC": "P12349", "DEC": "P12350", "JRK": "P12351"}
AT_REST = f"{JOG_ACTIVE} = 0"
_JOG = re.compile(rf"AXIS0 JOG (?:(INC|VEL|ACC|DEC|JRK) ({NUMBER})|(OFF)|(?:VEL|ACC|DEC|JRK))")
_SET = re.compile(rf"(?:(SET|CLR) (\d+)|(P|BIT)(\d+) ?= ?(?:{NUMBER}))")
_PLACE = re.compile(r"\b(P|BIT)(\d+)\b")


def bar_of_line(case: Case, text: str) -> str | None:
    """Why a line that jogs or sets may not be typed, "" if it may; None for another line."""
    if jog := _JOG.fullmatch(text):
        if case.moves is None and (jog[1] == "INC" or jog[3]):
            return "the case says nothing about motion"
        if jog[1] in SETTINGS and SETTINGS[jog[1]] not in case.changes:
            return f"{SETTINGS[jog[1]]} is not among the changes of the case"
        return ""
    if done := _SET.fullmatch(text):
        target = f"{done[3]}{done[4]}" if done[3] else f"BIT{done[2]}"
        return "" if target in case.changes else f"{target} is not among the changes of the case"
    return None


def bar_of_travel(case: Case) -> str:
    """Why the motion of a case is not certain to stay within its travel and speed; "" if it is.

    A jog that is stopped, or followed by the next before it has ended, may be at any place between
    its begin and its end.
    """
    if case.moves is None:
        return ""
    speed_ups: float | None = None
    low_u = high_u = 0.0  # where the axis may be, from the begin of the case
    end_u = (0.0, 0.0)  # where it is at rest
    for step in case.steps:
        if step.word.form.startswith("wait until") and step.values[0] == AT_REST:
            low_u, high_u = end_u
        jog = _JOG.fullmatch(_typed(step))
        if jog is None:
            continue
        if jog[1] == "VEL":
            speed_ups = float(jog[2])
        if jog[3]:  # OFF
            end_u = low_u, high_u
        if jog[1] != "INC":
            continue
        if speed_ups is None or not 0.0 < speed_ups <= case.moves.speed_ups:
            return f"line {step.at.number}: no JOG VEL up to {case.moves.speed_ups:g} is before it"
        end_u = low_u + float(jog[2]), high_u + float(jog[2])
        low_u, high_u = min(low_u, end_u[0]), max(high_u, end_u[1])
        if max(-low_u, high_u) > case.moves.travel_u:
            return f"line {step.at.number}: it may go beyond {case.moves.travel_u:g} units"
    return ""


def _typed(step: Step) -> str:
    return str(step.values[-1]) if step.values and "LINE" in step.word.form else ""


@dataclass(frozen=True, slots=True)
class Permission:
    """What the user of a card allows: motion of one axis, settings that are put back."""

    axis: int | None = None
    may_set: bool = False

    def bar(self, case: Case) -> str:
        """Why a case is not allowed."""
        if case.moves and self.axis is None:
            return "it moves a motor (--moving AXIS)"
        if case.changes and not (self.may_set or case.moves):
            return f"it sets {', '.join(case.changes)} and puts them back (--setting)"
        return bar_of_travel(case)


def for_axis(case: Case, axis: int) -> Case:
    """A case about axis 0, about another one."""

    def moved(text: str) -> str:
        return of_axis(re.sub(r"\bAXIS0\b", f"AXIS{axis}", text), axis)

    def line(each: Line) -> Line:
        return each._replace(text=moved(each.text))

    steps = tuple(
        replace(
            step,
            values=tuple(moved(each) if isinstance(each, str) else each for each in step.values),
            at=line(step.at),
            below=[line(each) for each in step.below],
        )
        for step in case.steps
    )
    return replace(case, steps=steps, changes=tuple(map(moved, case.changes)))


def of_axis(text: str, axis: int) -> str:
    """A text with the parameters and flags of axis 0 as those of another axis."""

    def place(found: re.Match[str]) -> str:
        number = int(found[2])
        if found[1] == "P":
            is_of_axis = 0 <= number - axes.parameters[0] < axes.PARAMETERS_SIZE
            return f"P{number + axes.PARAMETERS_SIZE * axis * is_of_axis}"
        word, bit = divmod(number, BITS_PER_WORD)
        for words in AXIS_WORDS:
            if word + FLAG_WORD_BASE == words[0]:
                number = BITS_PER_WORD * (words[axis] - FLAG_WORD_BASE) + bit
        return f"BIT{number}"

    return _PLACE.sub(place, text)


def changed(cases: Iterable[Case]) -> list[str]:
    """What cases set, each once."""
    return list(dict.fromkeys(each for case in cases for each in case.changes))


def reach_of(cases: Sequence[Case]) -> Reach:
    """The longest travel and the highest speed of cases."""
    reaches = [case.moves for case in cases if case.moves]
    return Reach(
        max((each.travel_u for each in reaches), default=0.0),
        max((each.speed_ups for each in reaches), default=0.0),
    )
