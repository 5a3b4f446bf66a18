"""Codes, words and forms of other controls that a dialect refuses, each with its reason.

A row is the hint of the error that refuses it, and a row of the page of codes; `lines` shows
each of its codes, words or forms once. Codes that only the other dialect has are not listed:
they follow from the tables of both.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

from msgspec import Struct

ANY = frozenset[str]()
MOST_SHOWN = 20  # codes of one row that are named one by one


class Refusal(Struct, frozen=True):
    """A refused code, word or form, with the reason."""

    shown: str  # as named on the page of codes
    reason: str
    error: str
    lines: tuple[str, ...]
    codes: frozenset[str] = ANY  # as `G5.1`
    words: str = ""  # letters
    beside: frozenset[str] = ANY  # codes beside which the words are refused; empty: everywhere
    form: re.Pattern[str] | None = None


class Refusals(Struct, frozen=True):
    """The refusals of one dialect."""

    rows: tuple[Refusal, ...] = ()

    def of_code(self, name: str) -> str:
        """The reason why a code (`G5.1`) is refused; empty if there is no row for it."""
        return next((row.reason for row in self.rows if name in row.codes), "")

    def of_word(self, letter: str, beside: Iterable[str]) -> str:
        """The reason why a word is refused beside codes; empty if there is no row for it."""
        names = set(beside)
        rows = (row for row in self.rows if letter in row.words)
        return next((row.reason for row in rows if not row.beside or row.beside & names), "")

    def of_form(self, raw: str, column: int) -> str:
        """The reason for a syntax error at a column (from 1); empty if there is no row for it."""
        text, at = raw.upper(), column - 1
        for row in self.rows:
            found = row.form.finditer(text) if row.form else ()
            if any(one.start() <= at < one.end() for one in found):
                return row.reason
        return ""


def other_dialect(name: str) -> str:
    """The hint for a code that another dialect has."""
    return f"a code of the dialect {name}: --dialect {name}"


def _codes(names: str, reason: str) -> Refusal:
    codes = names.split()
    error = "E203" if codes[0][0] == "G" else "E205"
    shown = names if len(codes) <= MOST_SHOWN else f"{codes[0]} … {codes[-1]}"
    return Refusal(shown, reason, error, tuple(codes), codes=frozenset(codes))


def _words(letters: str, beside: str, error: str, line: str, reason: str) -> Refusal:
    """Letters refused beside codes; `line` shows one of them, as `_`."""
    shown = " ".join(letters) + (f" beside {beside}" if beside else "")
    lines = tuple(line.replace("_", letter) for letter in letters)
    return Refusal(shown, reason, error, lines, words=letters, beside=frozenset(beside.split()))


def _form(shown: str, pattern: str, reason: str, *lines: str, error: str = "E104") -> Refusal:
    return Refusal(shown, reason, error, lines, form=re.compile(pattern))


_AXES = "axes are X Y Z A B C U V"
_DWELL = "a dwell moves nothing: write the axis words in a block of their own"
_LATHES = (
    _codes("G7 G8", "diameter and radius mode are for lathes; leave the code out"),
    _codes("G33 G33.1", "no motion is synchronised with the spindle; G84 and G74 tap at feed"),
    _codes("G96", "constant surface speed is for lathes; write S in rev/min"),
)
_FEED_PER_TURN = _codes("G95", "no feed per turn of the spindle; write F in units per minute")
_POCKETS = _codes("G12 G13", "no circular pockets; `openacr mill part` writes them")
_POLAR = _codes("G15 G16", "no polar coordinates; write X and Y")
_TILTED = _codes("G68.2", "planes are not tilted; arcs lie in XY, ZX or YZ")
_ONE_SPINDLE = _form("`$` (number of a spindle)", r"\$\d", "there is one spindle; leave $ out",
                     "M3 S100 $1")  # fmt: skip
_MANY_SYSTEMS = _codes("G54.1", "work systems are G54 to G59.2; G101 to G199 are fixtures")

ACROMILL = Refusals((
    *_LATHES,
    _POCKETS,
    _POLAR,
    _MANY_SYSTEMS,
    _TILTED,
    _FEED_PER_TURN,
    _words("XYZABCUV", "G4", "E206", "G4 F1 _1", _DWELL),
    _words("P", "G4", "E240", "G4 P2", "seconds are F here; G4 P is of the dialect rs274ngc"),
    _words("P", "G64", "E206", "G64 P.1",
          "no path tolerance in a program; G64 P is of the dialect rs274ngc"),
    _words("WE", "", "E206", "G0 _1", _AXES),
    _form("`O100 sub`", r"O\s*(?:\d+|<[^>]*>)\s*[A-Z]+",
          "O-words are of the dialect rs274ngc; here IF, GOTO, GOSUB and G65", "O100 SUB"),
    _form("`#<name>`", r"#\s*<", "parameters have numbers; names are of the dialect rs274ngc",
          "#<A>=1", error="E105"),
    _form("`WHILE DO ELSE ENDIF END`", r"\b(?:WHILE|DO|ELSE|ENDIF|END)",
          "loops and branches are IF .. THEN GOTO and labels", "WHILE [#1 LT 5] DO1", "ELSE",
          "ENDIF", "DO1", "END1", error="E105"),
    _form("`[ ]`", r"\[", "expressions stand in ( ); [ ] is of the dialect rs274ngc", "G1 X[1]",
          error="E105"),
    _form("`EQ NE GT GE LT LE`", r"\b(?:EQ|NE|GT|GE|LT|LE)\b",
          "comparisons are = <> > >= < <=",
          *[f"IF P1 {word} 1 THEN GOTO 5" for word in ("EQ", "NE", "GT", "GE", "LT", "LE")],
          error="E108"),
    _form("`**`", r"\*\*", "no powers; multiply", "#1=2**3"),
    _form("`@ ^`", r"[@^]", "no polar coordinates; write X and Y", "G1 F10 @5 ^30"),
    _ONE_SPINDLE,
))  # fmt: skip

RS274NGC = Refusals((
    *_LATHES,
    _POCKETS,
    _codes("G15 G16", "polar coordinates are words: @ for the distance, ^ for the angle"),
    _codes("G17.1 G18.1 G19.1", "arcs lie in XY, ZX or YZ, not in planes of U, V, W"),
    _codes("G50 G51", "nothing is scaled in this dialect, only in acromill"),
    _codes("G54.1", "work systems are G54 to G59.3"),
    _codes("G68 G69", "nothing is rotated in this dialect, only in acromill"),
    _TILTED,
    _codes("G70 G71", "turning cycles are for lathes; inches are G20, millimetres G21"),
    _codes("G71.1 G71.2 G72 G72.1 G72.2", "turning cycles are for lathes"),
    _codes("G76", "threading is for lathes; boring with a shift is G76 of acromill"),
    _codes("G87 G88", "no back boring and no boring with a retract by hand in this dialect"),
    _FEED_PER_TURN,
    _codes("M19", "the spindle is not brought to an angle in this dialect"),
    _codes("M67 M68", "the store has no analog outputs for programs; S drives the spindle"),
    _codes(" ".join(f"M{n}" for n in range(100, 200)),
           "codes of the user are part programs M100.TXT and so on in the folder of P900010"),
    _words("F", "G4", "E222", "G4 F1", "seconds are P here; G4 F is of the dialect acromill"),
    _words("IJQ", "G10", "E206", "G10 L1 P1 _1", "angles and orientation are for lathe tools"),
    _words("P", "G30", "E206", "G30 P2 X1", "there is one second reference point; leave P out"),
    _words("E", "M66", "E206", "M66 P0 E0 L0", "programs do not read analog inputs"),
    _words("W", "", "E206", "G0 W1", _AXES),
    _form("`#<_ini[..]>`, `#<_hal[..]>`", r"#<_(?:INI|HAL)\[[^>]*>",
          "there is no INI file and no HAL; write the value, or a parameter of the store",
          "#1=#<_ini[AXIS]MAX>", "#1=#<_hal[a.b]>", error="E211"),
    _form("`#<_current_pocket>`, `#<_selected_pocket>`", r"#<_(?:CURRENT|SELECTED)_POCKET>",
          "the tool changer knows no pockets, only tools", "#1=#<_current_pocket>",
          "#1=#<_selected_pocket>", error="E211"),
    _form("`#<_vmajor>`, `#<_vminor>`", r"#<_VM(?:AJ|IN)OR>", "this is no version of LinuxCNC",
          "#1=#<_vmajor>", "#1=#<_vminor>", error="E211"),
    _form("names that have no value", r"#<_[^>]*>",
          "a name has a value once the program has assigned one", "#1=#<_none>", error="E211"),
    _form("`$I`", r"\$I\b", "a file is called by O<name> call", "$I A.TXT"),
    _form("`IF GOTO GOSUB RET PRINT INPUT WHILE`",
          r"\b(?:IF|GOTO|GOSUB|RET|PRINT|INPUT|WHILE)\b",
          "branches, loops and calls are O-words: O100 if [..]",
          "IF 1 THEN GOTO 5", "GOTO 5", "GOSUB 5", "RET", 'PRINT "A"', 'INPUT "A",#1',
          "WHILE [1] DO1"),
    _form("`P5=..`", r"P\s*\d+\s*=", "parameters are #n; P is a word", "P5=1"),
    _form("`( )` around an expression", r"\(", "( ) is a remark; expressions stand in [ ]",
          "X(1+2)", error="E105"),
    _form("`= <> > >= < <=`", r"[=<>]", "comparisons are EQ NE GT GE LT LE",
          *[f"#1=[1{sign}2]" for sign in ("=", "<>", ">", ">=", "<", "<=")], error="E107"),
    _ONE_SPINDLE,
))  # fmt: skip
