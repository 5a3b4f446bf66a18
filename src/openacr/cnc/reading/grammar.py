"""Grammars of the dialects: their differences as tables for one parser."""

import re

from msgspec import Struct

from openacr.cnc.reading import functions as f
from openacr.cnc.reading import refusals
from openacr.cnc.reading.functions import Function
from openacr.cnc.reading.refusals import Refusals


class Operator(Struct, frozen=True):
    """An operator between two operands; higher levels bind tighter."""

    level: int
    function: Function


class Grammar(Struct, frozen=True):
    """How expressions, parameters and statements are written."""

    brackets: str  # opening and closing
    parameters: str  # letters that name a parameter
    operators: dict[str, Operator]
    functions: dict[str, Function]
    states: frozenset[str]  # INP, OUT, BIT: questions to the machine, and assignments
    statements: frozenset[str]  # keywords
    has_names: bool  # #<name> and EXISTS
    has_o_words: bool
    not_level: int  # operands of NOT reach to operators of this level; 0: no NOT
    refusals: Refusals  # forms of other controls
    pairs: frozenset[str] = frozenset()  # functions written F[y]/[x]
    polar: str = ""  # words for distance and angle
    number: re.Pattern[str] = re.compile(r"\d+(?:\.\d*)?|\.\d+")


_COMMON = {
    "SIN": f.SIN, "COS": f.COS, "TAN": f.TAN, "ASIN": f.ASIN, "ACOS": f.ACOS, "SQRT": f.SQRT,
    "ABS": f.ABS, "ROUND": f.ROUND, "FIX": f.FIX, "FUP": f.FUP, "LN": f.LN, "EXP": f.EXP,
}  # fmt: skip

ACROMILL = Grammar(
    brackets="()",
    parameters="P#",
    operators={
        "<=": Operator(5, f.AT_MOST),
        ">=": Operator(5, f.AT_LEAST),
        "<>": Operator(5, f.UNEQUAL),
        "<": Operator(5, f.LESS),
        ">": Operator(5, f.MORE),
        "=": Operator(5, f.EQUAL),
        "+": Operator(6, f.ADD),
        "-": Operator(6, f.SUBTRACT),
        "*": Operator(7, f.MULTIPLY),
        "/": Operator(7, f.DIVIDE),
        "MOD": Operator(7, f.MOD),
        "AND": Operator(3, f.AND),
        "XOR": Operator(2, f.XOR),
        "OR": Operator(1, f.OR),
    },
    functions={**_COMMON, "ATAN": f.ATAN, "INT": f.INT},
    states=frozenset({"INP", "OUT", "BIT"}),
    statements=frozenset({"IF", "GOTO", "GOSUB", "RET", "PRINT", "INPUT", "$I"}),
    has_names=False,
    has_o_words=False,
    not_level=4,
    refusals=refusals.ACROMILL,
)

RS274NGC = Grammar(
    brackets="[]",
    parameters="#",
    operators={
        "**": Operator(8, f.POWER),
        "*": Operator(7, f.MULTIPLY),
        "/": Operator(7, f.DIVIDE),
        "MOD": Operator(7, f.MOD_UP),
        "+": Operator(6, f.ADD),
        "-": Operator(6, f.SUBTRACT),
        "EQ": Operator(5, f.EQUAL),
        "NE": Operator(5, f.UNEQUAL),
        "GT": Operator(5, f.MORE),
        "GE": Operator(5, f.AT_LEAST),
        "LT": Operator(5, f.LESS),
        "LE": Operator(5, f.AT_MOST),
        "AND": Operator(3, f.AND),
        "XOR": Operator(3, f.XOR),
        "OR": Operator(3, f.OR),
    },
    functions={**_COMMON, "ATAN": f.ATAN2},
    states=frozenset(),
    statements=frozenset(),
    has_names=True,
    has_o_words=True,
    not_level=0,
    refusals=refusals.RS274NGC,
    pairs=frozenset({"ATAN"}),
    polar="@^",
    number=re.compile(r"\d(?:[ \t]*\d)*(?:[ \t]*\.(?:[ \t]*\d)*)?|\.(?:[ \t]*\d)+"),  # blanks
)
