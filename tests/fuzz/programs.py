"""Programs that mostly mean something: whole ones, and ones with damage."""

import random
from pathlib import Path

from tests.soak.noise import Noise

BROKEN = sorted(Path(__file__).with_name("broken").glob("*.8k"))
_OPERATORS = (
    "+", "-", "*", "/", "**", "MOD", "AND", "OR", "XOR", "NAND", "NOR", "XNOR", "<<", ">>", "=",
    "<>", "<", ">", "<=", ">=",
)  # fmt: skip
_FUNCTIONS = (
    "ABS", "SIN", "COS", "TAN", "ATN", "SQRT", "LOG", "LN", "INT", "FLOOR", "CEIL", "SGN", "NOT",
)  # fmt: skip
_NUMBERS = (
    "0", "1", "2", "3", "-1", "7", "32", "0.5", "1e9", "1E-9", "2147483647", "-2147483648",
    "&HFF", "4095", "100", "1e38", "255",
)  # fmt: skip
_VARIABLES = (
    "P0", "P1", "P2", "P99", "P100", "P4095", "P4096", "P12288", "P6916", "P9999", "P40959",
    "P(P0)", "P(LV0+1)", "LV0", "LV1", "LV4", "LV5", "LV(P0)", "SV0", "SV(LV0)", "DV1",
    "DV(P1-1)", "LA0(0)", "LA0(P0)", "LA(LV0)(LV1)", "LA1(4)", "BIT32", "BIT33", "BIT(P0)",
    "BIT524288", "count",
)  # fmt: skip
_TEXTS = (
    '"a"', '""', "$V0", "$V(P0)", "CHR$(P0)", "STR$(LV0)", "LEFT$($V0, P0)", 'UCASE$("q")',
    "MID$($V1, P1, P2)", "$V9", "SPACE$(P0)", 'STRING$(P0, "xy")', "INKEY$(0)",
)  # fmt: skip
_PLAIN = (
    "SET 32", "CLR 32", "SET(P0)", "CLR BIT(LV0)", "DWL 0.001", "DWL (P0)", "INH 32", "INH -33",
    "X{e}", "Y/{e}", "X{e} Y{e}", "ACC {e}", "VEL {e}", "DEC 0",
    "STP {e}", "JOG FWD X", "JOG OFF X", "JOG ABS X{e}", "PRINT {e}; {t}", "? {e}, {v}",
    'PRINT USING "##.#"; {e}', "DIM LV(5)", "DIM LA(2)", "DIM LA0(5)", "DIM $V(3,20)", "CLEAR",
    "MASK {e}", "TRG {e}", "PPU X{e}", "RES X", "REN X", "KVF X", "CIRCCW X({e},{e}) Y({e},{e})",
    "SINE X(0,90,90,{e})", "HALT", "PAUSE", "RUN PROG1", "HALT PROG1", "RUN", "GEAR RATIO X{e}",
    "CAM OFF X", "MOV X{e}", "PGAIN X{e}", "NEW", "LIMIT X", "CLOSE #1", 'OPEN "STREAM3:" AS #1',
    "PRINT #1, {e}", "INPUT LV0", "AXIS0 ON", "PERIOD", "TRON", "TROFF", "BLK", "AUT", "STEP",
    "ATTACH", "DETACH", "BSC X{e}", "EXC X({e},{e})", "PROG 1",
    "RETURN", "END",
)  # fmt: skip


_THERE = ("P0", "P1", "P2", "P99", "LV0", "LV1", "LV4", "SV0", "DV1", "BIT32", "BIT33", "count")
_HARMLESS = ("+", "-", "*", "AND", "OR", "XOR", "<", ">", "=", "<=", "<>")
_QUIET = 17  # the first of the plain statements end no program


class Programs:
    """A source of programs that can be repeated: same seed, same programs."""

    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)
        self.noise = Noise(seed)
        self.is_sound = False
        self._open: list[str] = []

    def value(self, depth: int = 0) -> str:
        """An expression."""
        chance = self.random
        kind = chance.random()
        if depth > 3 or kind < 0.3:
            return chance.choice(_NUMBERS)
        if kind < 0.6:
            return self.variable()
        if kind < 0.7:
            return f"{chance.choice(_FUNCTIONS)}({self.value(depth + 1)})"
        left, right = self.value(depth + 1), self.value(depth + 1)
        operator = chance.choice(_HARMLESS if self.is_sound else _OPERATORS)
        return f"({left} {operator} {right})"

    def variable(self) -> str:
        """A variable; in a sound program mostly one that exists."""
        is_there = self.is_sound and self.random.random() < 0.97
        return self.random.choice(_THERE if is_there else _VARIABLES)

    def statement(self) -> str:
        """One statement."""
        chance = self.random
        if chance.random() < 0.35:
            if chance.random() < 0.2:
                return (
                    f"$V{chance.randrange(4)} = {chance.choice(_TEXTS)} + {chance.choice(_TEXTS)}"
                )
            return f"{self.variable()} = {self.value()}"
        text = chance.choice(_PLAIN[:_QUIET] if self.is_sound and chance.random() < 0.9 else _PLAIN)
        while "{" in text:
            text = text.replace("{e}", f"({self.value()})", 1)
            text = text.replace("{v}", self.variable(), 1)
            text = text.replace("{t}", chance.choice(_TEXTS), 1)
        return text

    def line(self) -> str:
        """A line for the prompt: sound, nearly sound, or noise."""
        kind = self.random.random()
        if kind < 0.4:
            return self.noise.line()
        line = " : ".join(self.statement() for _ in range(self.random.choice((1, 1, 1, 2, 3))))
        return self.damaged(line) if kind < 0.6 else line

    def damaged(self, line: str) -> str:
        """The line with one thing cut out, doubled or replaced."""
        chance = self.random
        if not line:
            return chr(chance.randrange(32, 256))
        at = chance.randrange(len(line))
        to = min(len(line), at + chance.randrange(1, 6))
        other = chr(chance.randrange(32, 256))
        return chance.choice(
            (line[:at] + line[to:], line[:to] + line[at:], line[:at] + other + line[at + 1 :])
        )

    def program(self, length: int) -> list[str]:
        """The lines of a program: three of four are sound, so that they run for a while."""
        chance = self.random
        self.is_sound = chance.random() < 0.75
        lines: list[str] = []
        self._open = []  # the words that close what is open
        labels = iter(chance.sample(range(6), 6))
        while len(lines) < length:
            kind = chance.random()
            if kind < 0.08:
                label = next(labels, None)
                lines.append(f"_L{chance.randrange(6) if label is None else label}")
                if label is None and self.is_sound:
                    lines.pop()
            else:
                lines.append(self._line_of_program(kind))
        while self._open:
            lines.append(self._open.pop())
        self.is_sound = False
        return lines

    def _line_of_program(self, kind: float) -> str:
        chance = self.random
        if kind < 0.2:
            return self._opened()
        if kind < 0.32 and self._open:
            return self._open.pop()
        if kind < 0.35:
            return f"{chance.choice(('GOTO', 'GOSUB'))} L{chance.randrange(6)}"
        if kind < 0.42:
            target = chance.choice((self.statement(), f"GOTO L{chance.randrange(6)}"))
            return f"IF ({self.value()}) THEN {target}"
        if kind < 0.45 and not self.is_sound:
            return self.line()
        if kind < 0.47 and (not self.is_sound or {"WEND", "NEXT"} & set(self._open)):
            return "BREAK"
        return self.statement()

    def _opened(self) -> str:
        if self._open[-1:] == ["ENDIF"] and self.random.random() < 0.3:
            return f"ELSEIF ({self.value()})"
        text, end = self.random.choice(
            (
                (f"IF ({self.value()})", "ENDIF"),
                (f"WHILE ({self.value()})", "WEND"),
                (f"FOR LV{self.random.randrange(3)} = 1 TO {self.value(2)}", "NEXT"),
                (f"IF ({self.value()}) : {self.statement()}", "ENDIF"),
                ("ELSE", ""),
            )
        )
        if not end and self.is_sound:
            return self.statement()
        if end and (self.is_sound or self.random.random() < 0.95):
            self._open.append(end)
        return text
