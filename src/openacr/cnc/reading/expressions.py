"""Parse expressions into formulas, by precedence climbing.

    expression = prefix { operator prefix }        tighter levels first
    prefix     = [NOT] [+|-] operand
    operand    = number | ( expression ) | parameter | FUNCTION ( expression )

An opening parenthesis where an operand is due begins an expression; anywhere else it
begins a comment.
"""

import re

from openacr.cnc.reading.findings import CodeError
from openacr.cnc.reading.formulas import Call, Named, Node, Number, Parameter, State
from openacr.cnc.reading.functions import NEGATE, NOT
from openacr.cnc.reading.grammar import Grammar

DEEPEST = 40
_INTEGER = re.compile(r"\d+")
_WORD = re.compile(r"[A-Z]+")
_NAME = re.compile(r"<([^<>]*)>")
_UPPER = str.maketrans("abcdefghijklmnopqrstuvwxyz", "ABCDEFGHIJKLMNOPQRSTUVWXYZ")
_MINUS = "\u2212\u2013"  # as printed
BLANKS = " \t\x0b\x0c"


class ExpressionReader:
    """A reader at a position in one line, and of the expressions that begin there."""

    def __init__(self, raw: str, grammar: Grammar) -> None:
        self.raw = raw
        self.text = raw.translate(_UPPER)
        self.grammar = grammar
        self.open, self.close = grammar.brackets[0], grammar.brackets[1]
        self.pos = 0
        self.depth = 0
        self.warnings: list[tuple[str, int]] = []
        for printed in _MINUS:
            if printed in raw:
                self.text = self.text.replace(printed, "-")

    # --- small steps ------------------------------------------------------------------

    @property
    def column(self) -> int:
        """The present column, from 1."""
        return self.pos + 1

    def fault(self, code: str, detail: str = "", hint: str = "") -> CodeError:
        """Make an error at the present column."""
        return CodeError(code, self.column, detail, hint)

    def blanks(self) -> None:
        """Skip blanks."""
        text, pos = self.text, self.pos
        while pos < len(text) and text[pos] in BLANKS:
            pos += 1
        self.pos = pos

    def peek(self) -> str:
        """The next character after blanks; empty at the end."""
        self.blanks()
        return self.text[self.pos] if self.pos < len(self.text) else ""

    def match(self, wanted: str) -> bool:
        """Consume a literal if it comes next."""
        self.blanks()
        if not self.text.startswith(wanted, self.pos):
            return False
        self.pos += len(wanted)
        return True

    def gap(self) -> None:
        """Skip blanks and comments between tokens."""
        while self.peek() == "(":
            self.comment()

    def comment(self) -> str:
        """Consume a comment; returns its text without parentheses."""
        end = self.text.find(")", self.pos)
        if end < 0:
            raise self.fault("E103")
        inner = self.raw[self.pos + 1 : end]
        self.pos = end + 1
        return inner

    def deeper(self) -> None:
        """Count nested parentheses and indirections."""
        self.depth += 1
        if self.depth > DEEPEST:
            raise self.fault("E108", hint=f"nested deeper than {DEEPEST}")

    # --- expressions ------------------------------------------------------------------

    def expression(self, level: int = 1) -> Node:
        """An expression of operators of at least this level."""
        left = self.prefix()
        while True:
            self.gap()
            name = self.operator()
            if not name or self.grammar.operators[name].level < level:
                return left
            operator = self.grammar.operators[name]
            self.pos += len(name)
            left = Call(operator.function, (left, self.expression(operator.level + 1)))

    def operator(self) -> str:
        """The next operator, without consuming it."""
        operators = self.grammar.operators
        text, pos = self.text, self.pos
        for size in (3, 2, 1):
            if text[pos : pos + size] in operators:
                return text[pos : pos + size]
        return ""

    def prefix(self) -> Node:
        """Read an operand with its signs, or NOT and the operands it applies to."""
        if self.grammar.not_level and self.match("NOT"):
            self.deeper()
            inner = self.expression(self.grammar.not_level + 1)
            self.depth -= 1
            return Call(NOT, (inner,))
        is_negative = False
        while self.peek() and self.text[self.pos] in "+-":
            is_negative ^= self.text[self.pos] == "-"
            self.pos += 1
        operand = self.operand()
        return negative(operand) if is_negative else operand

    def operand(self) -> Node:
        """A number, parameter, function or an expression in parentheses."""
        char = self.peek()
        if char and (char.isdecimal() or char == "."):
            return self.number()
        if char == self.open:
            return self.bracketed()
        if char and char in self.grammar.parameters:
            return self.parameter()
        if char.isalpha():
            return self.function()
        raise self.fault("E105" if not char else "E104")

    def number(self) -> Number:
        """A number without exponent."""
        found = self.grammar.number.match(self.text, self.pos)
        if not found:
            raise self.fault("E106")
        after = found.end()
        if after < len(self.text) and self.text[after] in ".0123456789":
            raise CodeError("E106", after + 1)
        self.pos = after
        return Number(float("".join(found[0].split())), found.start())

    def integer(self) -> int:
        """Digits."""
        self.blanks()
        found = _INTEGER.match(self.text, self.pos)
        if not found:
            raise self.fault("E105")
        self.pos = found.end()
        return int(found[0])

    def bracketed(self) -> Node:
        """`( expression )`."""
        if not self.match(self.open):
            raise self.fault("E107")
        self.deeper()
        inner = self.expression()
        self.gap()
        if not self.match(self.close):
            raise self.fault("E107")
        self.depth -= 1
        return inner

    def parameter(self) -> Node:
        """`P5`, `#5`, `P(5+1)`, `##5`, `#<name>`."""
        self.blanks()
        is_hash = self.text[self.pos] == "#"
        self.pos += 1
        if is_hash and self.grammar.has_names and self.peek() == "<":
            return Named(self.name())
        return Parameter(self.index(), is_hash)

    def index(self) -> Node:
        """The number of a parameter."""
        char = self.peek()
        if char == self.open:
            return self.bracketed()
        if char and char in self.grammar.parameters:
            self.deeper()
            inner = self.parameter()
            self.depth -= 1
            return inner
        if not char.isdecimal():
            raise self.fault("E105")
        return self.counted()

    def counted(self) -> Number:
        """Digits, as a number."""
        self.blanks()
        at = self.pos
        return Number(float(self.integer()), at)

    def name(self) -> str:
        """Read `<name>`, ignoring case and blanks."""
        found = _NAME.match(self.text, self.pos)
        if not found:
            raise self.fault("E106")
        self.pos = found.end()
        return found[1].replace(" ", "").replace("\t", "")

    def function(self) -> Node:
        """`SIN(30)`, `ATAN[1]/[2]`, `INP(3)`."""
        found = _WORD.match(self.text, self.pos)
        name = found[0] if found else ""
        if self.grammar.has_names and name == "EXISTS":
            return self.exists()
        is_state = name in self.grammar.states
        if not is_state and name not in self.grammar.functions:
            raise self.fault("E104")
        self.pos += len(name)
        operand = self.bracketed()
        if is_state:
            return State(name, operand)
        operands: tuple[Node, ...] = (operand,)
        if name in self.grammar.pairs:
            if not self.match("/"):
                raise self.fault("E108", hint=f"{name}[y]/[x]")
            operands += (self.bracketed(),)
        return Call(self.grammar.functions[name], operands)

    def exists(self) -> Node:
        """`EXISTS[#<name>]`."""
        self.pos += len("EXISTS")
        if not (self.match("[") and self.match("#")) or self.peek() != "<":
            raise self.fault("E108")
        name = self.name()
        if not self.match("]"):
            raise self.fault("E107")
        return Named(name, is_test=True)

    # --- values of words ----------------------------------------------------------------

    def value(self) -> Node:
        """`[+|-] ( number | ( expression ) | parameter )`."""
        is_negative = self.sign()
        char = self.peek()
        if char and (char.isdecimal() or char == "."):
            operand: Node = self.number()
        elif char == self.open:
            operand = self.bracketed()
        elif char and char in self.grammar.parameters:
            operand = self.parameter()
        elif char.isalpha() and self.grammar.has_names:
            operand = self.function()
        else:
            raise self.fault("E105")
        return negative(operand) if is_negative else operand

    def sign(self) -> bool:
        """The sign of a value; two printed minus signs count as one, with a warning."""
        if self.match("+"):
            return False
        start = self.pos
        if not self.match("-"):
            return False
        if self.raw[self.pos - 1] in _MINUS:
            self.warnings.append(("W102", self.pos))
        if self.match("-"):
            if not (self.peek().isdecimal() or self.peek() == "."):
                self.pos = start + 1
                raise self.fault("E105")
            if not self.warnings:
                self.warnings.append(("W102", self.pos))
        return True


def negative(operand: Node) -> Node:
    """The negated operand."""
    if isinstance(operand, Number):
        return Number(-operand.number, operand.at)
    return Call(NEGATE, (operand,))
