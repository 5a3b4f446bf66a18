"""Findings of part programs: code, position and text of errors, warnings and alarms."""

from msgspec import Struct
from msgspec.structs import asdict

from openacr.errors import UserError

MOST = 100  # findings of one load

TEXTS = {
    "E101": "line too long",
    "E103": "comment not closed",
    "E104": "unexpected character",
    "E105": "value expected after letter",
    "E106": "number malformed",
    "E107": "parenthesis missing",
    "E108": "statement malformed",
    "E109": "text outside quotes",
    "E201": "two codes of one group",
    "E202": "word given twice",
    "E203": "unknown G code",
    "E204": "integer expected",
    "E205": "unknown M code",
    "E206": "word has no meaning in this block",
    "E207": "axis not configured",
    "E210": "arithmetic error",
    "E211": "parameter number out of range",
    "E212": "parameter is read only",
    "E220": "label not found",
    "E221": "label defined twice",
    "E222": "value out of range",
    "E223": "automatic tool change without input",
    "E230": "arc radii differ too much",
    "E231": "arc without centre or radius",
    "E232": "arc radius is zero",
    "E233": "radius too small for the end point",
    "E234": "word not used in this plane",
    "E235": "spline word missing or wrong",
    "E236": "polar coordinates not possible here",
    "E240": "dwell time missing or out of range",
    "E241": "G10 word or number out of range",
    "E242": "G27/G28/G29/G30 not possible",
    "E243": "probing with compensation, or no probe",
    "E244": "scale factor zero or unequal in an arc plane",
    "E245": "zero shifted outside a work system",
    "E250": "cycle word missing or wrong",
    "E251": "$I CYCLES.TXT missing",
    "E252": "G76 or G87 without Q",
    "E260": "nesting deeper than 10",
    "E261": "RET without GOSUB",
    "E262": "$I before M2, missing file, nested deeper than 8",
    "E263": "user label above 70000 with cycles included",
    "E264": "jump into a macro or cycle file",
    "E265": "no modal state is kept",
    "E270": "more than 1,000,000 labels",
    "E310": "G53 with compensation",
    "E311": "plane, scale or rotation change with compensation",
    "E312": "cycle or reference move with compensation",
    "E313": "G40 G41 G42 in an arc block, or first/last move is an arc",
    "E314": "spline with compensation",
    "E315": "arc radii differ by more than epsilon",
    "E320": "arc smaller than the tool",
    "E321": "no intersection",
    "E322": "gouge",
    "E401": "target beyond soft limit",
    "E403": "position beyond 32 bits of pulses",
    "W102": "doubled or typographic minus",
    "W211": "input test form",
    "W212": "G90 and G91 in one program",
    "W213": "plane change ends a cycle",
    "W214": "Z above R",
    "W215": "wrong spindle direction for tapping",
    "W216": "last block is M30 but M30 is an output code",
    "W217": "S 0 at M3",
    "W218": "motion with no F and no start feed chosen",
    "W219": "G98 level below R",
    "W220": "reserved parameter assigned",
    "W221": "F in a block that changes the unit",
    "W222": "text after the end of the program",
    "W230": "arc radii differ",
    "W310": "negative radius",
    "W311": "lead-in shorter than the radius",
    "W312": "lead-in crosses the part",
    "W313": "side changed without G40",
    "W320": "geometry adjusted",
    "W323": "path comes too near to another element",
    "W324": "chain broken by a waiting block",
    "W402": "feed never reached",
    "W403": "limits not testable",
    "W404": "probe not captured by the card",
    "W405": "nothing is wired to the code",
    "W406": "beyond the P0 to P99 that the set-up gives a card",
    "W407": "corner passed with a jerk limit and no tolerance",
    "A33": "axis not homed",
    "A36": "probe did not trip",
    "A61": "answer missing",
    "A62": "endless loop",
}


class Finding(Struct, frozen=True):
    """An error (`E105`), warning (`W212`) or alarm (`A62`) at a line and column, both from 1."""

    code: str
    text: str
    file: str
    line: int
    column: int = 1
    hint: str = ""
    block: str = ""  # the line as written

    @property
    def is_error(self) -> bool:
        """Whether the program may not be started."""
        return not self.code.startswith("W")

    def __str__(self) -> str:
        return placed(self.file, self.line, self.column, f"{self.code} {self.text}", self.hint)

    def data(self) -> dict[str, str | int]:
        """All of it for JSON."""
        return asdict(self)


def placed(file: str, line: int, column: int, text: str, hint: str) -> str:
    """What was found, as it is printed: its place, its text, the hint if there is one."""
    place = f"{file}:{line}:{column}: {text}"
    return f"{place} ({hint})" if hint else place


class CodeError(Exception):
    """An error in the present block: code and column; the caller adds file and line."""

    def __init__(self, code: str, column: int = 0, detail: str = "", hint: str = "") -> None:
        super().__init__(code, detail)
        self.code, self.column, self.detail, self.hint = code, column, detail, hint

    def at(self, file: str, line: int, block: str) -> Finding:
        """The finding for this error, with its position."""
        return found(self.code, file, line, self.column, self.detail, self.hint, block)


def found(
    code: str,
    file: str,
    line: int,
    column: int = 1,
    detail: str = "",
    hint: str = "",
    block: str = "",
) -> Finding:
    """Make a finding with the text of its code and an optional detail."""
    text = f"{TEXTS[code]}: {detail}" if detail else TEXTS[code]
    return Finding(code, text, file, line, max(1, column), hint, block)


class BlockError(UserError):
    """A block that cannot be executed; nothing of it has been done."""

    def __init__(self, finding: Finding) -> None:
        super().__init__(str(finding))
        self.finding = finding
