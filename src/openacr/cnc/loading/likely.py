"""Recognise the dialect of a part program by signs that only one dialect has.

Signs are codes that one dialect has and the other has not, statements and expressions, names of
post-processors in remarks, and centres of arcs that fit one reading of I and J alone. Each
has a weight; the dialect with the larger sum is likely, `acromill` where they are equal.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator

from msgspec import Struct, field

from openacr.cnc.codes import dialects as _registered  # noqa: F401 - fills the table
from openacr.cnc.codes.table import DIALECTS

ACROMILL, RS274NGC = "acromill", "rs274ngc"
SURE, CLEAR, FAINT = 10, 3, 1  # weights of signs
ENOUGH = 3  # for another dialect than acromill
NEAR, NEAR_SHARE = 0.002, 0.001  # radii of arcs, in units of the file and share
MOST_REASONS = 4

_REMARK = re.compile(r"\(([^()]*)\)|;(.*)")
_WORD = re.compile(r"([A-Z])\s*([-+]?(?:\d+\.?\d*|\.\d+))")
# Lines of moves with numbers alone have no sign but that of their arcs.
_ORDINARY = re.compile(
    r"\s*(?:N\d+\s*)?"
    r"(?:(?:G0*[0-3](?![\d.\s])|G0*[0-3]\s+(?![\d.])|[FIJKRXYZ]\s*[-+]?(?:\d+\.?\d*|\.\d+))\s*)*"
)
_EXPRESSION = re.compile(r"[\[#=]|[XYIJ]\s*\(")
_MAKERS = re.compile(
    r"\b(fusion(?: ?360)?|hsm(?:works|express)?|mastercam|vectric|v-?carve(?: pro)?|cut2d"
    r"|freecad|estlcam|sheetcam|flatcam|pcb2gcode|pcb-gcode|cambam|meshcam|artcam|pycam|heekscnc"
    r"|gcodetools|inkscape|linuxcnc|emc2?|mach ?[34]|grbl|carbide create|bobcad|solidcam"
    r"|gibbscam|camworks|featurecam|powermill|edgecam|rhinocam|sprutcam|deskproto)\b",
    re.IGNORECASE,
)
_PATTERNS: tuple[tuple[str, int, str, re.Pattern[str]], ...] = (
    (RS274NGC, SURE, "O-word", re.compile(
        r"^\s*O\s*(?:<[^>]*>|\d+|\[.*?\]|#\S+)\s*"
        r"(?:SUB|ENDSUB|CALL|WHILE|ENDWHILE|DO|IF|ELSEIF|ELSE|ENDIF|REPEAT|ENDREPEAT|RETURN|BREAK|CONTINUE)\b"
    )),
    (RS274NGC, SURE, "named parameter", re.compile(r"#\s*<")),
    (RS274NGC, SURE, "expression in brackets", re.compile(r"\[")),
    (ACROMILL, SURE, "statement", re.compile(
        r"\bIF\b.*\bGOTO\b|^\s*(?:N\d+\s*)?(?:GOTO|GOSUB|RET|PRINT|INPUT)\b|^\s*\$I\b"
    )),
    (ACROMILL, SURE, "parameter P", re.compile(r"(?:^|[\s(])P\d+\s*=|[A-Z]\s*\([^)]*[P#]\d")),
    (RS274NGC, CLEAR, "dwell G4 P", re.compile(r"G0*4(?!\d|\.).*P\s*[\d.]")),
    (ACROMILL, CLEAR, "dwell G4 F", re.compile(r"G0*4(?!\d|\.)\s*F")),
    (RS274NGC, CLEAR, "polar word", re.compile(r"@\s*[-+]?[\d.\[#]")),
    (RS274NGC, CLEAR, "tolerance G64 P", re.compile(r"G64\s*P")),
    (RS274NGC, FAINT, "framed by %", re.compile(r"^\s*%")),
    (RS274NGC, FAINT, "length G43 H", re.compile(r"G43(?!\.).*H\s*\d")),
    (RS274NGC, FAINT, "end M30", re.compile(r"M30(?!\d)")),
    (RS274NGC, FAINT, "safety line with G17, G40 and G80", re.compile(
        r"^(?=.*G17(?!\d))(?=.*G40(?!\d))(?=.*G80(?!\d))"
    )),
)  # fmt: skip


class Sign(Struct, frozen=True):
    """A sign of one dialect, and the line where it was first found."""

    dialect: str
    weight: int
    what: str
    line: int

    def __str__(self) -> str:
        return f"{self.what} in line {self.line}"


class Likely(Struct):
    """The signs of a text, one of each kind."""

    signs: list[Sign] = field(default_factory=list)
    circle: str = ""  # the two readings of the first whole circle that has two

    def weight(self, dialect: str) -> int:
        """The sum of the weights for a dialect."""
        return sum(sign.weight for sign in self.signs if sign.dialect == dialect)

    @property
    def dialect(self) -> str:
        """The recognised dialect."""
        other = self.weight(RS274NGC)
        return RS274NGC if other >= ENOUGH and other > self.weight(ACROMILL) else ACROMILL

    @property
    def reasons(self) -> list[str]:
        """The strongest signs of the likely dialect, in the order of their lines."""
        return _strongest([sign for sign in self.signs if sign.dialect == self.dialect])

    @property
    def doubts(self) -> list[str]:
        """The strongest signs against the likely dialect; habits do not speak against rs274ngc."""
        least = CLEAR if self.dialect == RS274NGC else FAINT
        against = [sign for sign in self.signs if sign.dialect != self.dialect]
        return _strongest([sign for sign in against if sign.weight >= least])


def _strongest(signs: list[Sign]) -> list[str]:
    signs.sort(key=lambda sign: (-sign.weight, sign.line))
    return [str(sign) for sign in sorted(signs[:MOST_REASONS], key=lambda sign: sign.line)]


def likely(lines: Iterable[str], centres: int = 2) -> Likely:
    """Collect the signs of lines; `centres` is how acromill reads I and J at first (G200)."""
    found: dict[tuple[str, str], Sign] = {}
    arcs = _Arcs()
    for number, raw in enumerate(lines, start=1):
        text = raw.upper()
        arcs.read_line(number, text)
        if _ORDINARY.fullmatch(text):
            continue
        for dialect, weight, what in _signs(text):
            found.setdefault((dialect, what), Sign(dialect, weight, what, number))
    result = Likely(list(found.values()))
    codes = {sign.what for sign in result.signs}
    if not codes & {"G90.1", "G91.1", "G200"}:
        result.signs += arcs.signs(centres)
        result.circle = arcs.circle if centres == 2 else ""
    return result


def _signs(text: str) -> Iterator[tuple[str, int, str]]:
    """The signs of one line in capitals."""
    for remark in _REMARK.finditer(text):
        maker = _MAKERS.search(remark[1] or remark[2] or "")
        if maker:
            yield RS274NGC, CLEAR, f"post-processor {maker[1].title()}"
    statement = text.partition(";")[0]
    code = _REMARK.sub(" ", statement)
    for dialect, weight, what, pattern in _PATTERNS:
        if pattern.search(statement if what == "parameter P" else code):
            yield dialect, weight, what
    for letter, digits in _WORD.findall(code):
        if letter in "GM":
            yield from _code_sign(letter, float(digits))


def _code_sign(letter: str, number: float) -> Iterator[tuple[str, int, str]]:
    """The sign of a code that only one dialect has."""
    own, other = DIALECTS[ACROMILL].table, DIALECTS[RS274NGC].table
    rows = (own.gcodes, other.gcodes) if letter == "G" else (own.mcodes, other.mcodes)
    weight = CLEAR if letter == "G" else FAINT
    if (number in rows[0]) != (number in rows[1]):
        yield ACROMILL if number in rows[0] else RS274NGC, weight, f"{letter}{number:g}"


class _Arcs:
    """Counts the readings of I and J that give equal radii, in absolute XY moves."""

    def __init__(self) -> None:
        self._at: list[float | None] = [None, None]
        self._motion = 1.0
        self._is_incremental = False
        self._is_elsewhere = False  # another plane, or places that are not written
        self._fits: dict[int, list[int]] = {1: [], 2: []}  # lines, by reading
        self.circle = ""  # the first whole circle, which is round in both readings

    def read_line(self, line: int, text: str) -> None:
        """Read one line, in capitals."""
        code = _REMARK.sub(" ", text)
        words = _WORD.findall(code)
        values = {letter: float(digits) for letter, digits in words if letter in "XYIJ"}
        for letter, digits in words:
            if letter == "G":
                self._code(float(digits))
        if _EXPRESSION.search(text.partition(";")[0]):
            self._at = [None, None]
            return
        start = self._at
        end = [self._next(axis, values.get("XY"[axis])) for axis in range(2)]
        self._at = end
        if self._motion in (2, 3) and ("I" in values or "J" in values):
            self._judge(line, start, end, values)

    def _code(self, number: float) -> None:
        if number in (0, 1, 2, 3):
            self._motion = number
        elif number in (90, 91):
            self._is_incremental = number == 91
        elif number in (17, 18, 19):
            self._is_elsewhere = number != 17

    def _next(self, axis: int, value: float | None) -> float | None:
        at = self._at[axis]
        if value is None:
            return at
        if self._is_incremental:
            return None if at is None else at + value
        return value

    def _judge(
        self, line: int, start: list[float | None], end: list[float | None], words: dict[str, float]
    ) -> None:
        (x, y), (u, v) = start, end
        if x is None or y is None or u is None or v is None or self._is_elsewhere:
            return
        i, j = words.get("I"), words.get("J")
        centres = {
            1: (x + (i or 0.0), y + (j or 0.0)),
            2: (x if i is None else i, y if j is None else j),
        }
        if (x, y) == (u, v):
            if not self.circle and centres[1] != centres[2]:
                positions, distances = (_circle(centres[k], (x, y)) for k in (2, 1))
                self.circle = (
                    f"I and J of the whole circle in line {line} are read as positions"
                    f" ({positions}); {RS274NGC} reads distances ({distances})"
                )
            return
        fit = [
            reading
            for reading, c in centres.items()
            if _is_round(math.dist((x, y), c), math.dist((u, v), c))
        ]
        if len(fit) == 1:
            self._fits[fit[0]].append(line)

    def signs(self, centres: int) -> Iterator[Sign]:
        """The sign of the arcs, if they agree."""
        distances, positions = self._fits[1], self._fits[2]
        if distances and not positions and centres != 1:
            yield Sign(RS274NGC, CLEAR, "I and J from the start of the arc", distances[0])
        if positions and not distances and centres == 2:
            yield Sign(ACROMILL, CLEAR, "I and J as positions", positions[0])


def _circle(centre: tuple[float, float], start: tuple[float, float]) -> str:
    """A whole circle in words."""
    x, y = centre
    return f"radius {math.dist(centre, start):.6g} about X{x:.6g} Y{y:.6g}"


def _is_round(one: float, other: float) -> bool:
    return min(one, other) > NEAR and abs(one - other) <= max(NEAR, NEAR_SHARE * max(one, other))
