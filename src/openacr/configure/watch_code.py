"""Programs and PLCs that monitor drives and limits, and the answers stored on the card.

Firmware since 1.18.15 monitors limits itself; there program 15 stores the answers as remarks,
from which they can be read back. For older firmware PLC 5 (6 and 7, where one is not enough)
latches the limit switches in flags; the flags of drives and axes themselves are beyond the
reach of a PLC. Program 7 shows the state of the drives in flags and acts on limit switches,
on position errors and on positions beyond the software limits in P100-P131; it keeps the
answers too.
"""

from collections.abc import Iterator, Sequence

from openacr.configure.answers import Answers, AxisAnswers
from openacr.configure.setup_code import FLAGS_PER_AXIS, SOFT_NEGATIVE, SOFT_POSITIVE
from openacr.map.rows import axes as axis_rows

ANSWER = "REM | "
AXES_PER_PLC = 6

# Flags of generated code: one per axis, those of axes 8 to 15 after those of 0 to 7.
DRIVE_FAULTED, DRIVE_DISABLED, DRIVE_ENABLED = 1952, 1968, 1984
SOFT_LIMIT_HIT, POSITIVE_LIMIT_HIT, NEGATIVE_LIMIT_HIT = 2000, 2016, 2032

# Flags of axis 0 on the card.
_KILL_MOTION, _ENABLED, _FAULT = 8467, 8465, 8477
_LIMIT_STATES, _LIMIT_LATCHES = (16128, 16129), (16132, 16133)


def _not_excess_error(axis: AxisAnswers) -> int:
    """The flag that is set while the axis is in its error band."""
    first = 769 if axis.number < 8 else 7681 - 8 * FLAGS_PER_AXIS
    return first + FLAGS_PER_AXIS * axis.number


def plc_codes(answers: Answers) -> list[list[str]]:
    """The lines of PLC 5 and of the PLCs after it."""
    axes = answers.axis
    groups = [axes[first : first + AXES_PER_PLC] for first in range(0, len(axes), AXES_PER_PLC)]
    return [list(_plc(group)) for group in groups]


def _plc(axes: Sequence[AxisAnswers]) -> Iterator[str]:
    rungs = ["PBOOT"]
    for axis in axes:
        load = "LD NOT" if axis.limits.contacts_are_closed else "LD"
        for side, hit in enumerate((POSITIVE_LIMIT_HIT, NEGATIVE_LIMIT_HIT)):
            if axis.limits.is_enabled:
                flag = hit + axis.number
                rungs += [f"{load} {axis.limit_input + side}", f"OR {flag}", f"OUT {flag}"]
    for place, rung in enumerate(rungs):
        yield f"{10 * (place + 1)} {rung}"


def watch_code(answers: Answers, source: str) -> Iterator[str]:
    """Program 7: releases latches, stops what is beyond its software limits or its error band."""
    yield "PROGRAM"
    yield "PBOOT"
    yield from _remarks(source)
    yield "_Watch"
    for axis in answers.axis:
        yield f"REM Axis {axis.number}: {axis.name}"
        yield from _drive(axis)
        yield from _latches(axis)
        yield from _soft_limit(axis)
        yield from _position_error(axis)
    yield "GOTO Watch"
    yield "ENDP"


def _drive(axis: AxisAnswers) -> Iterator[str]:
    """Show faulted, enabled and disabled."""
    shift = FLAGS_PER_AXIS * axis.number
    faulted, enabled = DRIVE_FAULTED + axis.number, DRIVE_ENABLED + axis.number
    disabled = DRIVE_DISABLED + axis.number
    yield f"IF (BIT{_FAULT + shift}) THEN SET {faulted}"
    yield f"IF (BIT{_FAULT + shift}=0) THEN CLR {faulted}"
    yield f"IF (BIT{_ENABLED + shift}) THEN SET {enabled} CLR {disabled}"
    yield f"IF (BIT{_ENABLED + shift}=0) THEN CLR {enabled} SET {disabled}"


def _latches(axis: AxisAnswers) -> Iterator[str]:
    """A latched limit switch is released when it was left and its limit was acknowledged."""
    if not axis.limits.is_enabled:
        return
    shift = FLAGS_PER_AXIS * axis.number
    for side, hit in enumerate((POSITIVE_LIMIT_HIT, NEGATIVE_LIMIT_HIT)):
        state, latch = _LIMIT_STATES[side] + shift, _LIMIT_LATCHES[side] + shift
        flag = hit + axis.number
        yield f"IF ((BIT{flag}) AND (BIT{state}=0) AND (BIT{latch}=0)) THEN CLR {flag}"


def _soft_limit(axis: AxisAnswers) -> Iterator[str]:
    """Going beyond the limits stops the axis and its master once; coming back clears the flag."""
    if not axis.limits.watches_soft or axis.limits.soft is None:
        return
    number, flag = axis.number, SOFT_LIMIT_HIT + axis.number
    position, ppu = f"P{axis_rows.actual_position[number]}", f"P{axis_rows.ppu[number]}"
    high, low = f"P{SOFT_POSITIVE + axis.number}*{ppu}", f"P{SOFT_NEGATIVE + axis.number}*{ppu}"
    yield f"IF (({position}>{high}) OR ({position}<{low}))"
    yield f"IF (BIT{flag}=0)"
    yield f"SET {flag}"
    yield f"SET {_KILL_MOTION + FLAGS_PER_AXIS * axis.number}"
    yield "ENDIF"
    yield "ELSE"
    yield f"CLR {flag}"
    yield "ENDIF"


def _position_error(axis: AxisAnswers) -> Iterator[str]:
    """An enabled axis outside its error band is brought to rest."""
    inside, enabled = _not_excess_error(axis), DRIVE_ENABLED + axis.number
    kill = _KILL_MOTION + FLAGS_PER_AXIS * axis.number
    yield f"IF ((BIT{inside}=0) AND (BIT{enabled})) THEN SET {kill}"


def data_code(source: str) -> Iterator[str]:
    """Program 15: the answers, as remarks."""
    yield "PROGRAM"
    yield from _remarks(source)
    yield "ENDP"


def _remarks(source: str) -> Iterator[str]:
    for line in source.splitlines():
        if line.strip() and not line.lstrip().startswith("#"):
            yield f"{ANSWER}{line.strip()}"


def kept_answers(lines: Sequence[str]) -> str:
    """The answers in a listing of program 15 or 7."""
    found = (line.strip().partition(ANSWER) for line in lines)
    return "\n".join(text for _, mark, text in found if mark) + "\n"
