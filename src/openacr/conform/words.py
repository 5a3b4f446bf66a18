"""The words of cases: what a line may begin with, and what it does."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from pathlib import Path

from openacr.conform.form import (
    ANSWERS,
    BLOCK,
    DifferenceError,
    Line,
    Step,
    Time,
    compare,
    compare_messages,
    compare_text,
    compare_values,
    messages_taken,
    word,
)
from openacr.conform.stage import Stage
from openacr.project import Place
from openacr.source_check import check_text
from openacr.wording import counted

KEYS = {"^X": b"\x18", "^Y": b"\x19", "^Z": b"\x1a", "Esc": b"\x1b"}
PLC_BYTES = 8192  # reserved for a PLC that has no memory yet


# Bytes.


@word(">>BYTES")
def send_bytes(stage: Stage, step: Step, data: Sequence[int | None]) -> None:
    """Send bytes on the channel: 2A, "text", i32=5, f32=0.5 (the lowest byte first)."""
    stage.card.send(stage.channel, bytes(each or 0 for each in data))


@word("<<BYTES")
def receive_bytes(stage: Stage, step: Step, expected: Sequence[int | None]) -> None:
    """The next bytes the channel receives; `??` is any byte, nothing is 20 periods of silence."""
    shown = stage.reply(len(expected))
    is_same = len(shown) == len(expected) and all(
        wanted in (None, byte) for wanted, byte in zip(expected, shown, strict=True)
    )
    if not is_same:
        raise DifferenceError(_hexadecimal(expected), _hexadecimal(shown))


def _hexadecimal(data: Sequence[int | None]) -> str:
    return " ".join("??" if byte is None else f"{byte:02X}" for byte in data) or "(nothing)"


# The terminal.


@word(">LINE", ANSWERS, takes_remark=False, asks=True)
def type_and_compare(stage: Stage, step: Step, text: str) -> None:
    """Type a line and wait for the prompt; the lines below are its answer, all of it."""
    compare(step, stage.say(text))


@word("PROMPTLINE", ANSWERS, takes_remark=False, asks=True)
def type_after_prompt(stage: Stage, step: Step, prompt: str, text: str) -> None:
    """The same where the terminal must show this prompt; the prompt alone types nothing."""
    if stage.prompt != prompt:
        raise DifferenceError(prompt, stage.prompt)
    if text:
        compare(step, stage.say(text))


@word("type LINE", takes_remark=False)
def type_alone(stage: Stage, step: Step, text: str) -> None:
    """Type a line and wait for nothing; `shows:` compares what comes."""
    stage.pending[stage.channel] = stage.type(text).encode("latin-1")


@word("shows:", BLOCK)
@word("shows: TEXT", BLOCK, takes_remark=False)
def shows(stage: Stage, step: Step, text: str = "") -> None:
    """All that the terminal has shown since it was last compared, without the prompt at its end."""
    compare_text(step, text, stage.answer(stage.take()))


@word("prints:", BLOCK)
@word("prints: TEXT", BLOCK, takes_remark=False)
def prints(stage: Stage, step: Step, text: str = "") -> None:
    """All that programs have printed since `prints:` or the beginning; `\\` ends an open line."""
    *lines, last = stage.card.printed().replace("\r\n", "\n").split("\n")
    compare_text(step, text, [*lines, last + "\\"] if last else lines)


@word("press KEY", ANSWERS)
def press(stage: Stage, step: Step, key: str) -> None:
    """Press a key on the terminal; the lines below are what it shows, without a line end first."""
    stage.expect_silence()
    stage.card.send(stage.channel, KEYS[key])
    compare(step, stage.answer(stage.take().removeprefix("\n")))


@word("channel NAME")
def channel(stage: Stage, step: Step, name: str) -> None:
    """Go to another channel of the card: STREAM1 to STREAM5, COM1, COM2, DPCB, PACKETS."""
    stage.expect_silence()
    stage.channel = name


# Programs.


@word("program NUMBER:", BLOCK)
def program(stage: Stage, step: Step, number: int) -> None:
    """Store a program; lines without numbers are put between PROGRAM and ENDP."""
    _store(stage, f"PROG{number}", step.below)


@word("plc NUMBER:", BLOCK)
def plc(stage: Stage, step: Step, number: int) -> None:
    """Store a PLC program; memory is reserved for it where it has none."""
    _at_level(stage, "SYS", lambda: _reserve(stage, f"DIM PLC{number}({PLC_BYTES})"))
    _store(stage, f"PLC{number}", step.below)


def _reserve(stage: Stage, line: str) -> None:
    if (answer := stage.say(line)) not in ([], ["Re-dimensioned block"]):
        raise DifferenceError(f"{line}: no message", "\n".join(answer))


def _store(stage: Stage, level: str, lines: Sequence[Line]) -> None:
    is_bare = not lines[0].text[0].isdigit() and lines[0].text.upper() != "PROGRAM"

    def enter() -> None:
        if is_bare:
            stage.set_up("PROGRAM")
        for line in lines:
            if answer := stage.say(line.text):
                raise DifferenceError("a line the card stores", "\n".join(answer), line)
        if is_bare:
            stage.set_up("ENDP")

    _at_level(stage, level, enter)


def _at_level(stage: Stage, level: str, act: Callable[[], None]) -> None:
    """Do something at another level, and return to the present one."""
    before = stage.prompt.removesuffix(">")
    stage.set_up(level)
    act()
    stage.set_up(re.sub(r"^P(\d\d)$", r"PROG\1", before))


# Values.


@word("? WHAT -> RESULT", asks=True)
def value(stage: Stage, step: Step, what: str, expected: str) -> None:
    """Values of parameters, flags and expressions, with `;` between several: exactly these."""
    compare_values(stage.value, what, expected)


@word("? WHAT -> RESULT +- TOLERANCE", asks=True)
def value_within(stage: Stage, step: Step, what: str, expected: str, tolerance: float) -> None:
    """The same within a tolerance, whose reason is the remark after it."""
    compare_values(stage.value, what, expected, tolerance)


@word("note WHAT as NAME")
def note(stage: Stage, step: Step, what: str, name: str) -> None:
    """Keep a value for the expressions of `?` below, where it is `<NAME>`."""
    value = stage.value(what)
    if isinstance(value, str):
        raise DifferenceError("a number", value)
    stage.notes[name] = value


# Time.


@word("wait TIME")
def wait(stage: Stage, step: Step, time: Time) -> None:
    """Let time pass."""
    stage.card.advance(time.ticks(stage.card.period_s))


@word("wait until CONDITION within TIME")
def wait_until(stage: Stage, step: Step, condition: str, limit: Time) -> None:
    """Let time pass until `P` or `BIT`, its number, a relation and a value hold."""
    begun_tk = stage.card.tick
    stage.card.until(condition, limit.ticks(stage.card.period_s) * stage.card.period_s)
    stage.took_tk = stage.card.tick - begun_tk


@word("took TIME")
def took(stage: Stage, step: Step, time: Time) -> None:
    """How long the latest typed line or `wait until` took, to the servo period."""
    _compare_time(stage, time, 0.0)


@word("took TIME +- TOLERANCE periods")
def took_about(stage: Stage, step: Step, time: Time, tolerance: float) -> None:
    """The same within a count of servo periods, whose reason is the remark after it."""
    _compare_time(stage, time, tolerance)


def _compare_time(stage: Stage, time: Time, tolerance: float) -> None:
    expected_tk, period_s = time.ticks(stage.card.period_s), stage.card.period_s
    if abs(stage.took_tk - expected_tk) > tolerance:
        expected, shown = (
            f"{ticks * period_s:.6g} s ({counted(ticks, 'period')})"
            for ticks in (expected_tk, stage.took_tk)
        )
        raise DifferenceError(expected, shown)


# The world around the card.


@word("input NUMBER STATE")
def set_input(stage: Stage, step: Step, number: int, on: bool) -> None:
    """Switch an input; one that the machine drives is forced until it is released."""
    stage.card.world.set_input(number, on)


@word("release input NUMBER")
def release_input(stage: Stage, step: Step, number: int) -> None:
    """Release a forced input: the machine drives it again."""
    stage.card.world.release_input(number)


@word("analog PNUMBER = VALUE")
def analog(stage: Stage, step: Step, parameter: int, value: float) -> None:
    """Bring a voltage to the analog input that a parameter shows."""
    stage.card.world.set_analog(parameter, value)


@word("drag axis NUMBER by VALUE")
def drag(stage: Stage, step: Step, axis: int, by_u: float) -> None:
    """Move the load of an axis by hand, at once, by user units."""
    stage.card.world.drag(axis, by_u)


@word("fault axis NUMBER NAME VALUE")
@word("fault axis NUMBER NAME")
def fault(stage: Stage, step: Step, axis: int, kind: str, value: float = 0.0) -> None:
    """Cause a fault of the machine, of the kinds of docs/scenario.md."""
    stage.card.world.fault(axis, kind, value)


@word("mend axis NUMBER")
def mend(stage: Stage, step: Step, axis: int) -> None:
    """End the faults of an axis."""
    stage.card.world.mend(axis)


@word("flag NUMBER STATE")
def flag(stage: Stage, step: Step, number: int, on: bool) -> None:
    """Set or clear a flag directly, as SET and CLR do at any level."""
    stage.card.world.bit[number] = on


# Messages of check.


@word("check setup:", BLOCK)
def check_setup(stage: Stage, step: Step) -> None:
    """Messages of `openacr check` for a set-up file: `# E: text` or `# W: text` at their lines."""
    _check(step, Place.SETUP, 0)


@word("check program NUMBER:", BLOCK)
def check_program(stage: Stage, step: Step, number: int) -> None:
    """The same for a program."""
    _check(step, Place.PROGRAM, number)


@word("check plc NUMBER:", BLOCK)
def check_plc(stage: Stage, step: Step, number: int) -> None:
    """The same for a PLC program."""
    _check(step, Place.PLC, number)


def _check(step: Step, place: Place, number: int) -> None:
    text = "\n".join(messages_taken(step)) + "\n"
    faults = check_text(text, Path(f"{place.value}{number}.8k"), (place, number))
    compare_messages(step, [(each.line, each.is_warning, each.message) for each in faults])
