"""The instructions of a PLC: one row each; reader, compiler, listing and drawing use them."""

from __future__ import annotations

from collections.abc import Callable
from enum import Enum

from msgspec import Struct

from openacr.map.rows import plcs
from openacr.plc import scan_cy as scan

HIGHEST_FLAG = 8191
FIRST_PLC_FLAG = 1536
FLAGS_PER_PLC = 32
OBJECTS = plcs.COUNT  # timers, counters and latches


class Operand(Enum):
    """The kind of operand of an instruction."""

    NONE = "none"
    FLAG = "flag"
    TIMER = "TIM"
    COUNTER = "CNT"
    LATCH = "KR"

    @property
    def takes_preload(self) -> bool:
        """Whether a preload may follow the number."""
        return self in (Operand.TIMER, Operand.COUNTER)


class Instruction(Struct, frozen=True, eq=False):
    """One instruction; `operation` is its number in the scan, None for no operation.

    `takes` is the count of saved results it uses up; `is_output`: the next LD begins a rung.
    """

    words: tuple[str, ...]
    summary: str
    operand: Operand = Operand.NONE
    operation: int | None = None
    takes: int = 0
    is_output: bool = False
    synonyms: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """The words as they are written."""
        return " ".join(self.words)

    @property
    def is_negated(self) -> bool:
        """Whether the operand, or the result that is written, is inverted."""
        return bool((self.operation or 0) & scan.NEGATED)

    @property
    def is_frame(self) -> bool:
        """PROGRAM and ENDP frame the text and take no memory."""
        return self.words[0] in ("PROGRAM", "ENDP")

    def __repr__(self) -> str:
        return f"<{self.name}>"

    def __reduce__(self) -> tuple[Callable[[str], Instruction], tuple[str]]:
        """Pickle by name: a row is code, not data."""
        return find, (self.name,)


# fmt: off
LD = Instruction(("LD",), "Begin a rung, or a block of it, with a flag.",
                 Operand.FLAG, scan.OP_LOAD)
END = Instruction(("END",), "End the scan.")
ENDP = Instruction(("ENDP",), "Close the text; ends the scan.")

INSTRUCTIONS = (
    LD,
    Instruction(("LD", "NOT"), "Begin a rung, or a block of it, with an inverted flag.",
                Operand.FLAG, scan.OP_LOAD | scan.NEGATED, synonyms=("LDN",)),
    Instruction(("AND",), "A flag in series.", Operand.FLAG, scan.OP_AND),
    Instruction(("AND", "NOT"), "An inverted flag in series.",
                Operand.FLAG, scan.OP_AND | scan.NEGATED, synonyms=("ANDN",)),
    Instruction(("OR",), "A flag in parallel to all of the block.", Operand.FLAG, scan.OP_OR),
    Instruction(("OR", "NOT"), "An inverted flag in parallel to all of the block.",
                Operand.FLAG, scan.OP_OR | scan.NEGATED, synonyms=("ORN",)),
    Instruction(("AND", "LD"), "Connect the last two blocks in series.",
                operation=scan.OP_AND_BLOCK, takes=1, synonyms=("ANDB",)),
    Instruction(("OR", "LD"), "Connect the last two blocks in parallel.",
                operation=scan.OP_OR_BLOCK, takes=1, synonyms=("ORB",)),
    Instruction(("NOT",), "Invert the result.", operation=scan.OP_NOT),
    Instruction(("OUT",), "Write the result to a flag; more outputs may follow.",
                Operand.FLAG, scan.OP_OUT, is_output=True),
    Instruction(("OUT", "NOT"), "Write the inverted result to a flag.",
                Operand.FLAG, scan.OP_OUT | scan.NEGATED, is_output=True),
    Instruction(("SET",), "Set a flag if the result is true.",
                Operand.FLAG, scan.OP_SET, is_output=True),
    Instruction(("CLR",), "Clear a flag if the result is true.",
                Operand.FLAG, scan.OP_CLEAR, is_output=True),
    Instruction(("TIM",), "Write the result to a timer input; RUN sets the preload given, in ms.",
                Operand.TIMER, scan.OP_TIMER, is_output=True),
    Instruction(("CNT",), "First block to a counter clock, second to its reset; RUN sets the"
                " preload given.", Operand.COUNTER, scan.OP_COUNTER, takes=1, is_output=True),
    Instruction(("KR",), "First block to the set input of a latch, second to its reset.",
                Operand.LATCH, scan.OP_LATCH, takes=1, is_output=True),
    Instruction(("PBOOT",), "On the first line: start the PLC at power-up."),
    END,
    Instruction(("PROGRAM",), "Open the text."),
    ENDP,
)
# fmt: on

_OUTPUT_FLAG = {Operand.TIMER: 16, Operand.COUNTER: 20, Operand.LATCH: 28}
OBJECT_WORDS = {operand.value: operand for operand in _OUTPUT_FLAG}

BY_WORDS: dict[tuple[str, ...], Instruction] = {
    words: row
    for row in INSTRUCTIONS
    for words in (row.words, *((synonym,) for synonym in row.synonyms))
}
LONGEST = max(map(len, BY_WORDS))


def find(name: str) -> Instruction:
    """The instruction of this name, e.g. `AND NOT`."""
    return BY_WORDS[tuple(name.split())]


def output_flag(operand: Operand, number: int) -> int:
    """The output flag of a timer, counter or latch."""
    return FIRST_PLC_FLAG + FLAGS_PER_PLC * number + _OUTPUT_FLAG[operand]
