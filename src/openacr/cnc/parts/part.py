"""A part of the library: its program, and the head that describes its sizes.

    ;PART Keyhole plate
    ;PARAM P200 "Length" in 4.0 0.1 24.0      unit, default, lowest, highest
    ;CHECK P201*2 <= P200
    ;START lower left corner

Units are in, mm, deg and n (a plain number).
"""

import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

from msgspec import Struct

from openacr.cnc.reading.expressions import ExpressionReader
from openacr.cnc.reading.findings import CodeError, Finding
from openacr.cnc.reading.formulas import Node
from openacr.cnc.reading.grammar import ACROMILL
from openacr.errors import UserError

FIRST_CELL, TOOL_RADIUS, LEAD_IN = 200, 224, 233
INCH, MM = "in", "mm"
UNIT_NAMES = (INCH, MM, "deg", "n")

_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)"
_SIZE = re.compile(rf'P(\d+)\s+"([^"]+)"\s+(\w+)\s+({_NUMBER})\s+({_NUMBER})\s+({_NUMBER})\s*')
_HEAD = re.compile(r";\s*(PART|PARAM|CHECK|START)\b\s*(.*)", re.IGNORECASE)


class PartError(UserError):
    """An error in a part, or sizes it does not allow."""

    def __init__(self, findings: Iterable[Finding]) -> None:
        self.findings = tuple(findings)
        super().__init__("\n".join(map(str, self.findings)))


class Size(Struct, frozen=True):
    """One parameter of a part, in its own unit."""

    cell: int
    text: str
    unit: str
    default: float
    low: float
    high: float
    line: int

    @property
    def accepted(self) -> str:
        """The values it takes, in words."""
        unit = "" if self.unit == "n" else f" {self.unit}"
        return f"{self.low:g} to {self.high:g}{unit}"

    def __str__(self) -> str:
        return f"P{self.cell} {self.text}"

    def data(self) -> dict[str, Any]:
        """The size as JSON."""
        return {
            "cell": self.cell,
            "text": self.text,
            "unit": self.unit,
            "default": self.default,
            "low": self.low,
            "high": self.high,
        }


class Rule(NamedTuple):
    """A condition between sizes."""

    text: str
    line: int
    condition: Node


class Part(Struct, frozen=True):
    """A part program with its head."""

    path: Path
    title: str
    sizes: tuple[Size, ...]
    rules: tuple[Rule, ...]
    start: str
    text: str

    @property
    def name(self) -> str:
        """The name by which the part is chosen."""
        return self.path.stem.upper()

    def size(self, wanted: str) -> Size:
        """A size by its cell or its name."""
        word = wanted.strip().casefold()
        for size in self.sizes:
            if word in (f"p{size.cell}", size.text.casefold()):
                return size
        known = ", ".join(map(str, self.sizes))
        raise UserError(f"{self.name} has no size {wanted.strip()} (it has {known})")

    def data(self) -> dict[str, Any]:
        """The part with its sizes and what must hold between them, as JSON."""
        return {
            "name": self.name,
            "title": self.title,
            "start": self.start,
            "sizes": [size.data() for size in self.sizes],
            "checks": [rule.text for rule in self.rules],
        }


# --- reading ----------------------------------------------------------------------------


def read_part(path: Path) -> Part:
    """Read a part from a file; PartError with all errors of its head."""
    text = text_of(path)
    findings: list[Finding] = []
    title, start = "", ""
    sizes: list[Size] = []
    rules: list[Rule] = []
    for kind, rest, line in head_lines(text):
        try:
            if kind == "PARAM":
                sizes.append(_size(rest, line, sizes))
            elif kind == "CHECK":
                rules.append(Rule(rest, line, _condition(rest)))
            elif kind == "PART":
                title = rest
            else:
                start = rest
        except CodeError as fault:
            findings.append(fault.at(str(path), line, rest))
    if not title:
        findings.append(
            CodeError("E108", hint=";PART and a title are missing").at(str(path), 1, "")
        )
    if findings:
        raise PartError(findings)
    return Part(path, title, tuple(sizes), tuple(rules), start, text)


def text_of(path: Path) -> str:
    """The text of a file, whatever its bytes."""
    try:
        return path.read_bytes().decode("utf-8", errors="replace")
    except OSError as error:
        raise UserError(f"{path}: cannot be read: {error.strerror}") from None


def head_lines(text: str) -> Iterator[tuple[str, str, int]]:
    """Kind, rest and line of the lines that describe the part."""
    for line, raw in enumerate(text.splitlines(), 1):
        if raw.strip() and not raw.lstrip().startswith(";"):
            return
        found = _HEAD.fullmatch(raw.strip())
        if found:
            yield found[1].upper(), found[2].strip(), line


def _size(text: str, line: int, others: Iterable[Size]) -> Size:
    found = _SIZE.fullmatch(text)
    if not found:
        raise CodeError("E108", hint=';PARAM P200 "Length" in default lowest highest')
    cell, words, unit = int(found[1]), found[2], found[3].lower()
    default, low, high = (float(found[k]) for k in (4, 5, 6))
    if not FIRST_CELL <= cell < LEAD_IN:
        raise CodeError("E211", hint="sizes are P200 to P232")
    if any(cell == other.cell for other in others):
        raise CodeError("E202", detail=f"P{cell}")
    if unit not in UNIT_NAMES:
        raise CodeError("E108", hint=f"the unit is one of {', '.join(UNIT_NAMES)}")
    if not low <= default <= high:
        raise CodeError("E222", detail=f"the default {default:g} is not {low:g} to {high:g}")
    return Size(cell, words, unit, default, low, high, line)


def _condition(text: str) -> Node:
    reader = ExpressionReader(text, ACROMILL)
    condition = reader.expression()
    if reader.peek():
        raise reader.fault("E104")
    return condition
