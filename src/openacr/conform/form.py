"""The form of a case: its lines as rows, and the words a line may begin with.

A word is a function with the form of its line, `@word("wait TIME")`: words of the form in capitals
are the KINDS of values it takes. `words.py` has them all; a new one is a function there.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

from openacr.errors import OpenacrError

ANSWERS, BLOCK = "answers", "block"  # what may stand below the line of a word


class Line(NamedTuple):
    """A line of a file."""

    number: int
    text: str


@dataclass(frozen=True, slots=True)
class Word:
    """What a line may begin with: its form, and the function that does it."""

    form: str
    pattern: re.Pattern[str]
    convert: tuple[Callable[[str], Any], ...]
    act: Callable[..., None]
    below: str  # ANSWERS, BLOCK or nothing
    takes_remark: bool  # whether ` # ...` at the end of the line is a remark
    asks: bool  # whether it changes nothing that the line it types does not change


@dataclass(frozen=True, slots=True)
class Step:
    """A line of a case with its values and what is below it."""

    word: Word
    values: tuple[Any, ...]
    at: Line
    below: list[Line] = field(default_factory=list)


@dataclass(frozen=True, slots=True)
class Machine:
    """The card and machine of a case: the folder of a project, or the text of a machine.toml."""

    folder: Path | None = None
    text: str = ""


@dataclass(frozen=True, slots=True)
class Claim:
    """An id a case proves, in full or a clause of it."""

    id: str
    clause: str = ""


class Reach(NamedTuple):
    """How far a case moves axis 0 from where it is, and how fast."""

    travel_u: float
    speed_ups: float


@dataclass(frozen=True, slots=True)
class Case:
    """A case, or one row of its table."""

    name: str
    path: Path
    line: int
    proves: tuple[Claim, ...]
    source: str
    rests: str  # one of RESTS, and after a colon on what
    machine: Machine
    model: str  # whose answers it holds, where they differ from those of others
    needs: tuple[str, ...]  # what its model must have (facts.py)
    only: str  # "virtual": it needs the world around a virtual card
    moves: Reach | None  # axis 0 of a card in use
    changes: tuple[str, ...]  # parameters and flags of a card in use, which are put back
    steps: tuple[Step, ...]


class DifferenceError(OpenacrError):
    """What a card did that a case does not expect: the line, both texts."""

    def __init__(self, expected: object, shown: object, at: Line | None = None) -> None:
        self.expected, self.shown, self.at = str(expected), str(shown), at
        super().__init__(self.expected)

    def __str__(self) -> str:
        place = [f"  {self.at.text.strip()}"] if self.at else []
        return "\n".join(
            [*place, _under("expected: ", self.expected), _under("shown:    ", self.shown)]
        )


def _under(title: str, text: str) -> str:
    """A text of several lines beside its title."""
    return title + ("\n" + " " * len(title)).join(text.split("\n"))


# Values of a line.

_PACKED = {"i32": "<i", "u32": "<I", "f32": "<f", "f64": "<d", "i16": "<h", "u16": "<H"}
_BYTES = re.compile(
    r'\s*(?:(?P<hex>[0-9A-Fa-f]{2})(?!\S)|(?P<any>\?\?)(?!\S)|"(?P<text>[^"]*)"'
    r"|(?P<kind>[iuf](?:16|32|64))=(?P<value>[-+.\deE]+)(?!\S))"
)


def bytes_of(text: str) -> list[int | None]:
    """`00 "VER" i32=-1 ??` as bytes, the lowest of a number first; None is any byte."""
    found: list[int | None] = []
    at = 0
    while text[at:].strip():
        part = _BYTES.match(text, at)
        if part is None or (part["kind"] and part["kind"] not in _PACKED):
            kinds = ", ".join(f"{kind}=..." for kind in _PACKED)
            raise ValueError(f'{text[at:].strip()!r}: expected 2A, ??, "text" or {kinds}')
        at = part.end()
        if part["any"]:
            found.append(None)
        elif part["kind"]:
            number = float(part["value"])
            is_real = part["kind"][0] == "f"
            try:
                found += struct.pack(_PACKED[part["kind"]], number if is_real else int(number))
            except (struct.error, OverflowError):
                raise ValueError(f"{number:.15g} is too large for {part['kind']}") from None
        else:
            found += bytes.fromhex(part["hex"]) if part["hex"] else part["text"].encode("latin-1")
    return found


@dataclass(frozen=True, slots=True)
class Time:
    """A time in seconds, or a count of servo periods."""

    value: float
    is_periods: bool

    def ticks(self, period_s: float) -> int:
        """The whole servo periods of the time."""
        return round(self.value if self.is_periods else self.value / period_s)


def time_of(text: str) -> Time:
    """`0.5 s`, `20 ms`, `5 periods`."""
    number, unit = text.split()
    return Time(float(number) * (0.001 if unit == "ms" else 1.0), unit.startswith("period"))


NUMBER = r"[-+]?\d+(?:\.\d*)?(?:[eE][-+]?\d+)?|[-+]?\.\d+(?:[eE][-+]?\d+)?"
KINDS: dict[str, tuple[str, Callable[[str], Any]]] = {
    "PROMPT": (r"(?:SYS|P\d\d|PLC\d)>", str),
    "LINE": (r"(?: ?.*)", lambda text: text.removeprefix(" ")),
    "BYTES": (r"(?: ?.*)", bytes_of),
    "TEXT": (r".+", str),
    "WHAT": (r".+?", str),
    "RESULT": (r"(?:(?! \+- ).)+", str),
    "CONDITION": (r".+?", str),
    "TIME": (r"[\d.]+ (?:s|ms|periods?)", time_of),
    "TOLERANCE": (f"(?:{NUMBER})", float),
    "VALUE": (f"(?:{NUMBER})", float),
    "NUMBER": (r"\d+", int),
    "STATE": (r"on|off", lambda text: text == "on"),
    "NAME": (r"[A-Za-z0-9.-]+", str),
    "KEY": (r"\^[XYZ]|Esc", str),
    "BUTTON": (r"START|STOP|RESUME|ABORT|ACKNOWLEDGE|CONFIRM", str),
    "MODE": (r"IDLE|RUN|WAIT|HOMING|PAUSED|HOLD|ALARM", str),
}
WORDS: list[Word] = []
_KIND = re.compile("|".join(KINDS))


def word(
    form: str, below: str = "", *, takes_remark: bool = True, asks: bool = False
) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Declare a word: the form of its line, and what may stand below it."""
    kinds = [KINDS[name] for name in _KIND.findall(form)]
    texts = map(re.escape, _KIND.split(form))
    pattern = next(texts) + "".join(
        f"({regex}){text}" for (regex, _), text in zip(kinds, texts, strict=True)
    )

    def declare(act: Callable[..., None]) -> Callable[..., None]:
        convert = tuple(kind[1] for kind in kinds)
        WORDS.append(Word(form, re.compile(pattern), convert, act, below, takes_remark, asks))
        return act

    return declare


_REMARK = re.compile(r"\s+#\s.*$")


def step_of(line: Line) -> Step | None:
    """The step of a line; None for a line that is no word. ValueError for a wrong value."""
    plain = _REMARK.sub("", line.text)
    for each in WORDS:
        match = each.pattern.fullmatch(plain if each.takes_remark else line.text)
        if match:
            if "TOLERANCE" in each.form and plain == line.text:
                raise ValueError("a tolerance has its reason after it: ` # why`")
            values = tuple(
                convert(text) for convert, text in zip(each.convert, match.groups(), strict=True)
            )
            return Step(each, values, line)
    first = _FIRST.match(line.text)
    begin = first[0] if first else ""
    forms = [each.form for each in WORDS if begin and _begins(each.form, begin)]
    if forms:
        raise ValueError(f"expected {' or '.join(forms)} (an answer that begins so: |{begin} ...)")
    return None


_FIRST = re.compile(r"[a-z]+\b|\?|>>|<<")  # with which only words begin, not what a card answers


def _begins(form: str, first: str) -> bool:
    begin = _FIRST.match(form)
    return begin is not None and begin[0] == first


# Lines a card shows.


def exactly(text: str) -> str:
    """A line as a case would hold it: between bars where its ends could be misread."""
    try:
        is_plain = (
            bool(text)
            and text == text.strip()
            and text[0] not in "#|["
            and not step_of(Line(0, text))
        )
    except ValueError:
        is_plain = False
    return text if is_plain else f"|{text}|"


def literal(text: str) -> str:
    """The line that a line of a case means: what is between bars, or itself."""
    return text[1:-1] if len(text) > 1 and text[0] == text[-1] == "|" else text.removeprefix("|")


def agree(expected: Sequence[Line], shown: Sequence[str]) -> bool:
    """Whether lines are those expected, where the line `...` is any lines."""
    pattern = "".join(
        "(?:.*\n)*" if text == "..." else re.escape(literal(text)) + "\n" for _, text in expected
    )
    return re.fullmatch(pattern, "".join(f"{line}\n" for line in shown)) is not None


def compare(step: Step, shown: Sequence[str]) -> None:
    """DifferenceError, at the first line that differs, unless the lines below a step were shown."""
    if agree(step.below, shown):
        return
    at = step.at
    for expected, line in zip(step.below, shown, strict=False):
        if expected.text == "..." or literal(expected.text) != line:
            at = expected
            break
    wanted = "\n".join(line.text for line in step.below) or "(nothing)"
    raise DifferenceError(wanted, "\n".join(map(exactly, shown)) or "(nothing)", at)


def compare_text(step: Step, text: str, shown: Sequence[str]) -> None:
    """Compare lines with the text beside a word and the block below it."""
    first = [Line(step.at.number, text)] if text else []
    compare(Step(step.word, step.values, step.at, [*first, *step.below]), shown)


def compare_values(
    read: Callable[[str], float | str], what: str, expected: str, tolerance: float = 0.0
) -> None:
    """Compare values with `;` between them; DifferenceError where one is not within tolerance."""
    names, wanted = ([each.strip() for each in text.split(";")] for text in (what, expected))
    shown = [read(name) for name in names]
    if len(shown) != len(wanted) or not all(map(_equals, shown, wanted, [tolerance] * len(shown))):
        within = f" +- {tolerance:g}" if tolerance else ""
        raise DifferenceError(expected + within, "; ".join(map(_written, shown)))


def _equals(shown: float | str, wanted: str, tolerance: float) -> bool:
    if isinstance(shown, str) or wanted.startswith('"'):
        return shown == wanted.strip('"')
    return abs(shown - float(wanted)) <= tolerance


def _written(shown: float | str) -> str:
    if isinstance(shown, str):
        return f'"{shown}"'
    return str(int(shown)) if float(shown).is_integer() else repr(shown)


# Messages beside the lines of a text.

_MESSAGE = re.compile(r"\s+# ([EW]): (.*?)(?=\s+# [EW]: |$)")


def messages_taken(step: Step) -> list[str]:
    """The lines below a step without the messages beside them."""
    return [_MESSAGE.sub("", line.text) for line in step.below]


def compare_messages(step: Step, found: Sequence[tuple[int, bool, str]]) -> None:
    """Compare the messages beside lines with those found: line, whether a warning, text."""
    for at, line in enumerate(step.below, 1):
        shown = [
            f"# {'W' if is_warning else 'E'}: {text}" for n, is_warning, text in found if n == at
        ]
        expected = [match[0].strip() for match in _MESSAGE.finditer(line.text)]
        if shown != expected:
            raise DifferenceError(
                " ".join(expected) or "(no message)", " ".join(shown) or "(no message)", line
            )
