"""Canonical entries of a part program as texts, a line each.

Axes and centres that are 0 are left out; numbers are rounded to 1e-6.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import degrees

from openacr.cnc.canonical import (
    AXIS_LETTERS,
    Arc,
    Ask,
    BlockEnd,
    Confirm,
    Coolant,
    Dwell,
    End,
    Entry,
    Line,
    Moves,
    Orient,
    Output,
    Pace,
    PathMode,
    Probe,
    Rapid,
    Say,
    SetBit,
    SetCell,
    Spindle,
    Stop,
    Sync,
    Tapping,
    Tool,
    Transfer,
    WaitBit,
)

DIGITS = 6  # after the point


def number(value: float) -> str:
    """A number to 1e-6, without zeros at its end."""
    text = f"{value:.{DIGITS}f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def at(point: Iterable[float], letters: str = AXIS_LETTERS) -> str:
    """The axes of a point that are not 0."""
    words = ((letter, number(value)) for letter, value in zip(letters, point, strict=False))
    return " ".join(letter + text for letter, text in words if text != "0") or "0"


def shown(entry: Entry) -> str:
    """An entry in short: of a move its kind and where it goes."""
    match entry:
        case Rapid(end=end):
            return f"rapid {at(end)}"
        case Line(end=end):
            return f"line {at(end)}"
        case Probe(end=end):
            return f"probe {at(end)}"
        case Arc():
            centre = ",".join(map(number, entry.centre))
            return f"arc {at(entry.end)} about {centre} by {number(degrees(entry.sweep_rad))}"
        case Spindle():
            return f"M{entry.spin.value} S{number(entry.rpm)}"
        case Coolant():
            return f"coolant {entry.mist:d}{entry.flood:d}"
        case Orient():
            return f"orient {entry.is_on:d}"
        case Tapping():
            return f"tapping {entry.is_on:d}"
        case Output():
            return f"out {entry.number} {entry.is_on:d}"
        case SetBit():
            return f"bit {entry.bit} {entry.is_on:d}"
        case WaitBit():
            return f"wait {entry.bit} {entry.is_on:d}"
        case Dwell():
            return f"dwell {number(entry.seconds)}"
        case Tool():
            return f"tool {entry.number}"
        case Transfer():
            return f"transfer P{entry.parameter}={number(entry.value)}"
        case SetCell():
            return f"set P{entry.parameter}={number(entry.value)}"
        case Say():
            return f"say {entry.text}"
        case Ask():
            return f"ask P{entry.parameter} {entry.text}"
        case Confirm():
            return f"confirm {entry.check.name.lower().replace('_', ' ')}"
        case Stop():
            return entry.pause.value
        case End():
            return "end"
        case _:
            return type(entry).__name__


def with_pace(entry: Entry) -> str:
    """An entry with the pace of a move: feed, path mode unless free, locks, whether inserted."""
    marks = [shown(entry)]
    if isinstance(entry, Line | Arc | Probe):
        marks += _pace(entry.pace)
    if isinstance(entry, Rapid) and entry.is_confirmed:
        marks.append("confirmed")
    if isinstance(entry, Rapid | Line | Arc) and entry.is_inserted:
        marks.append("inserted")
    return " ".join(marks)


def _pace(pace: Pace) -> Iterator[str]:
    yield f"F{number(pace.feed_upm)}"
    if pace.mode is not PathMode.FREE:
        yield pace.mode.value
    if pace.is_confirmed:
        yield "confirmed"
    if pace.is_locked:
        yield "locked"


def texts(entries: Iterable[Entry]) -> Iterator[str]:
    """What a program does, a line for an entry; without what marks places between them."""
    for entry in entries:
        if isinstance(entry, Moves):
            yield from map(with_pace, entry.entries())
        elif not (isinstance(entry, Sync | BlockEnd) or _is_end_of_text(entry)):
            yield with_pace(entry)


def _is_end_of_text(entry: Entry) -> bool:
    return isinstance(entry, End) and not entry.is_by_code
