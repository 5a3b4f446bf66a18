"""How the arguments of a command are written, and what its handler gets for them.

A form reads one argument (`parse`, when the line is read) and later turns what it read
into the value the handler gets (`evaluate`, when the command is executed). Forms are
listed in the row of a command in the order in which they are written; an optional one
that is left out gives None.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from openacr.basic.nodes import Apply, AxisRef, Expr, Number, Statement, Unary, is_text, resolved
from openacr.basic.nodes import Flag as FlagNode
from openacr.basic.nodes import Parameter as ParameterNode
from openacr.errors import CardError
from openacr.lang.lexer import Kind, Token
from openacr.messages import (
    INVALID_ARGUMENT,
    SYNTAX_ERROR,
    UNDEFINED_SYMBOL,
    Message,
)

if TYPE_CHECKING:
    from openacr.basic.parser import Parser
    from openacr.basic.run import Run


# what handlers get


@dataclass(frozen=True, slots=True)
class Axis:
    """An axis by number, with the name it was called by (for reports)."""

    number: int
    name: str


@dataclass(frozen=True, slots=True)
class AxisValue:
    """An axis with the values given for it; none at all is a query."""

    axis: Axis
    values: tuple[float, ...] = ()

    @property
    def is_query(self) -> bool:
        """Whether the value was left out."""
        return not self.values

    @property
    def value(self) -> float:
        """The only or first value."""
        return self.values[0]


@dataclass(frozen=True, slots=True)
class AxisTarget:
    """A target of a coordinated move."""

    axis: Axis
    values: tuple[float, ...]
    incremental: bool = False

    @property
    def value(self) -> float:
        """The only or first value."""
        return self.values[0]


@dataclass(frozen=True, slots=True)
class BitState:
    """A flag, and whether it is meant set or (written with a minus) clear."""

    number: int
    clear: bool = False


@dataclass(frozen=True, slots=True)
class SignedParameter:
    """A parameter, and whether it was written with a minus."""

    number: int
    negative: bool = False


@dataclass(frozen=True, slots=True)
class ObjectRef:
    """A word with a number: ENC 0, PROG 3; number -1 where the word needs none (ALL, NONE)."""

    word: str
    number: int = -1


# the forms


class Form(ABC):
    """One argument of a command."""

    names_axes = False
    silent = False  # the handler gets nothing for it

    def __init__(self, name: str = "", *, optional: bool = False) -> None:
        self.name = name
        self.optional = optional

    @abstractmethod
    def starts(self, p: Parser) -> bool:
        """Whether this argument begins at the cursor."""

    @abstractmethod
    def parse(self, p: Parser) -> object:
        """Read the argument."""

    def evaluate(self, run: Run, read: Any) -> object:
        """What the handler gets; `read` is what `parse` returned, None if left out."""
        return read

    def missing(self, p: Parser) -> Message:
        """The message when a required argument does not begin at the cursor."""
        return SYNTAX_ERROR


class Num(Form):
    """A number: literal, signed literal, variable or `(expr)`; the handler gets a float."""

    def starts(self, p: Parser) -> bool:
        """Whether a value begins here."""
        return p.at_value

    def parse(self, p: Parser) -> Expr:
        """Read the value."""
        return p.value()

    def evaluate(self, run: Run, read: Expr | None) -> float | None:
        """The number."""
        return None if read is None else run.value(read)


class Int(Num):
    """A whole number within limits; others are `Invalid argument`. The handler gets an int."""

    def __init__(
        self,
        name: str = "",
        low: int = -2147483648,
        high: int = 2147483647,
        *,
        optional: bool = False,
    ) -> None:
        super().__init__(name, optional=optional)
        self.low, self.high = low, high

    def evaluate(self, run: Run, read: Expr | None) -> int | None:
        """The number, truncated toward zero."""
        if read is None:
            return None
        value = run.integer(read)
        if not self.low <= value <= self.high:
            raise CardError(INVALID_ARGUMENT)
        return value


class Str(Form):
    """A string expression; the handler gets a str."""

    def starts(self, p: Parser) -> bool:
        """Whether a string begins here."""
        token = p.token
        if token.kind is Kind.WORD and token.text in p.aliases:
            return is_text(p.aliases[token.text])
        return token.kind is Kind.STRING or (
            token.kind is Kind.WORD and (token.text.startswith("$") or token.text.endswith("$"))
        )

    def parse(self, p: Parser) -> Expr:
        """Read the expression."""
        return p.expression()

    def evaluate(self, run: Run, read: Expr | None) -> str | None:
        """The text."""
        return None if read is None else run.text(read)


class Expression(Form):
    """A whole expression, number or string; the handler gets the tree and evaluates it."""

    def starts(self, p: Parser) -> bool:
        """Whether anything is left in the block."""
        return not p.at_block_end

    def parse(self, p: Parser) -> Expr:
        """Read the expression."""
        return p.expression()


class Condition(Form):
    """The condition of IF and WHILE: an expression that begins with a parenthesis."""

    def starts(self, p: Parser) -> bool:
        """Whether a parenthesis stands here."""
        return p.is_operator("(")

    def parse(self, p: Parser) -> Expr:
        """Read the expression."""
        return p.numeric()


class Lvalue(Form):
    """A variable that can be assigned; the handler gets the tree (see `Run.assign`)."""

    def starts(self, p: Parser) -> bool:
        """Whether a variable begins here."""
        return p.at_variable

    def parse(self, p: Parser) -> Expr:
        """Read the variable; an alias of a constant is no variable."""
        node = p.variable()
        if isinstance(resolved(node), Number | Apply | Unary):
            raise p.error(SYNTAX_ERROR)
        return node


class Word(Form):
    """One of some words; the handler gets it in upper case."""

    def __init__(self, *words: str, optional: bool = False) -> None:
        super().__init__("|".join(words), optional=optional)
        self.words = frozenset(words)

    def starts(self, p: Parser) -> bool:
        """Whether one of the words stands here."""
        return p.is_word(*self.words)

    def parse(self, p: Parser) -> str:
        """Take the word."""
        return str(p.advance().value)


class Mark(Form):
    """A fixed word or operator: AS, #, a comma. The handler gets True for an optional one."""

    def __init__(self, text: str, *, optional: bool = False) -> None:
        super().__init__(text, optional=optional)
        self.silent = not optional

    def starts(self, p: Parser) -> bool:
        """Whether it stands here."""
        return p.is_operator(self.name) or p.is_word(self.name)

    def parse(self, p: Parser) -> bool:
        """Take it."""
        p.advance()
        return True


class Group(Form):
    """`(a, b, ...)`: between `fewest` and `most` numbers; the handler gets a tuple of floats."""

    def __init__(
        self, *names: str, fewest: int | None = None, single: bool = False, optional: bool = False
    ) -> None:
        super().__init__(",".join(names), optional=optional)
        self.most = len(names)
        self.fewest = self.most if fewest is None else fewest
        self.single = single  # one value may stand without parentheses

    def starts(self, p: Parser) -> bool:
        """Whether a parenthesis (or a single value) begins here."""
        return p.is_operator("(") or (self.single and p.at_value)

    def parse(self, p: Parser) -> tuple[Expr, ...]:
        """Read the values."""
        if not p.is_operator("("):
            return (p.value(),)
        p.advance()
        found = [p.numeric()]
        while p.accept(","):
            found.append(p.numeric())
        p.expect(")")
        allowed = self.fewest <= len(found) <= self.most or (self.single and len(found) == 1)
        if not allowed:
            raise p.error(SYNTAX_ERROR)
        return tuple(found)

    def evaluate(self, run: Run, read: tuple[Expr, ...] | None) -> tuple[float, ...] | None:
        """The numbers."""
        return None if read is None else tuple(run.value(node) for node in read)


class Pair(Group):
    """`v` (plus v, minus -v) or `(plus, minus)`; the handler gets both."""

    def __init__(self, *, optional: bool = False) -> None:
        super().__init__("plus", "minus", single=True, optional=optional)

    def evaluate(self, run: Run, read: tuple[Expr, ...] | None) -> tuple[float, ...] | None:
        """Plus and minus value."""
        values = super().evaluate(run, read)
        if values is None or len(values) == 2:
            return values
        return values[0], -values[0]


@dataclass(frozen=True, slots=True)
class AxisItem:
    """An axis as written with what was written behind it."""

    axis: AxisRef
    argument: object = None


class AxisList(Form):
    """`axis argument axis argument ...`, or the argument alone behind the prefix `AXISn`.

    `each` is the form of the argument. The handler gets a tuple of `AxisValue` where
    `each` gives numbers (`Num`, `Pair`, `Group`), else of `(Axis, argument)`.
    """

    names_axes = True

    def __init__(self, each: Form | None = None, *, optional: bool = False) -> None:
        super().__init__("axis", optional=optional)
        self.each = each

    def starts(self, p: Parser) -> bool:
        """Whether an axis is named here (an unknown one too), or was by the prefix."""
        return p.prefix is not None or p.at_axis or p.at_unknown_word

    def missing(self, p: Parser) -> Message:
        """An unknown word is a symbol nobody defined."""
        return UNDEFINED_SYMBOL if p.at_unknown_word else SYNTAX_ERROR

    def parse(self, p: Parser) -> tuple[AxisItem, ...]:
        """Read as many axes as there are."""
        if p.prefix is not None:
            return (AxisItem(AxisRef("AXIS", p.prefix.number), self._argument(p)),)
        found = [AxisItem(p.axis(), self._argument(p))]
        while p.at_axis and not self._begins_statement(p):
            found.append(AxisItem(p.axis(), self._argument(p)))
        if p.at_unknown_word:
            raise p.error(UNDEFINED_SYMBOL)
        return tuple(found)

    def _begins_statement(self, p: Parser) -> bool:
        """Whether `AXISn` here is the prefix of a new command, as in `PPU X 1 AXIS1 ON`."""
        behind = p.ahead(2)
        return (
            p.is_word("AXIS")
            and p.ahead(1).kind is Kind.NUMBER
            and behind.kind is Kind.WORD
            and behind.value != "AXIS"
            and p.begins_command(behind)
        )

    def _argument(self, p: Parser) -> object:
        if self.each is None:
            return None
        if self.each.starts(p):
            return self.each.parse(p)
        if self.each.optional:
            return None
        raise p.error(SYNTAX_ERROR)

    def evaluate(self, run: Run, read: tuple[AxisItem, ...] | None) -> Any:
        """Axes with their values."""
        if read is None:
            return None
        return tuple(self._item(run, item) for item in read)

    def _item(self, run: Run, item: AxisItem) -> Any:
        axis = run.axis(item.axis)
        if self.each is None:
            return axis
        value = self.each.evaluate(run, item.argument)
        if not isinstance(self.each, Num | Group):
            return axis, value
        if value is None:
            return AxisValue(axis)
        return AxisValue(axis, value if isinstance(value, tuple) else (value,))


class AxisValues(AxisList):
    """`axis {value}...`: the usual axis command; a missing value is a query."""

    def __init__(self, *, optional: bool = False) -> None:
        super().__init__(Num("value", optional=True), optional=optional)


class AxisPairs(AxisList):
    """`axis {v | (plus,minus)}...`."""

    def __init__(self, *, optional: bool = False) -> None:
        super().__init__(Pair(optional=True), optional=optional)


class AxisGroups(AxisList):
    """`axis(a, b, ...)...`; `fewest` values are required, `values_optional` allows a query."""

    def __init__(
        self,
        *names: str,
        fewest: int | None = None,
        values_optional: bool = False,
        single: bool = False,
        optional: bool = False,
    ) -> None:
        each = Group(*names, fewest=fewest, single=single, optional=values_optional)
        super().__init__(each, optional=optional)


class Axes(AxisList):
    """`axis...` without values; the handler gets a tuple of `Axis`."""


@dataclass(frozen=True, slots=True)
class TargetItem:
    """A target as written."""

    axis: AxisRef
    values: tuple[Expr, ...]
    incremental: bool


class AxisTargets(Form):
    """`axis{/}value...` of linear moves; with `group`, `axis(a, b)...` without a slash.

    The handler gets a tuple of `AxisTarget`. `AXISn` is no target: `Undefined symbol`.
    """

    def __init__(self, group: Group | None = None, *, optional: bool = False) -> None:
        super().__init__("target", optional=optional)
        self.group = group

    def starts(self, p: Parser) -> bool:
        """Whether an axis is named here."""
        return p.at_axis and not p.is_word("AXIS")

    def missing(self, p: Parser) -> Message:
        """An unknown axis is a symbol nobody defined."""
        return UNDEFINED_SYMBOL if p.at_unknown_word or p.at_axis else SYNTAX_ERROR

    def parse(self, p: Parser) -> tuple[TargetItem, ...]:
        """Read as many targets as there are."""
        found = [self._target(p)]
        while self.starts(p):
            found.append(self._target(p))
        return tuple(found)

    def _target(self, p: Parser) -> TargetItem:
        axis = p.axis()
        if self.group is not None:
            if not self.group.starts(p):
                raise p.error(SYNTAX_ERROR)
            return TargetItem(axis, self.group.parse(p), False)
        incremental = p.accept("/")
        return TargetItem(axis, (p.value(),), incremental)

    def evaluate(self, run: Run, read: tuple[TargetItem, ...] | None) -> Any:
        """The targets."""
        if read is None:
            return None
        return tuple(
            AxisTarget(run.axis(item.axis), tuple(map(run.value, item.values)), item.incremental)
            for item in read
        )


@dataclass(frozen=True, slots=True)
class BitItem:
    """A flag number as written."""

    number: Expr
    clear: bool


class Bit(Form):
    """`n`, `BITn`, `BIT(expr)`, `(expr)` or an alias, with `signed` also negated.

    The handler gets a `BitState`.
    """

    def __init__(self, name: str = "bit", *, signed: bool = False, optional: bool = False) -> None:
        super().__init__(name, optional=optional)
        self.signed = signed

    def starts(self, p: Parser) -> bool:
        """Whether a flag begins here."""
        if p.is_operator("-"):
            return self.signed
        return p.at_value and not p.is_operator("+")

    def parse(self, p: Parser) -> BitItem:
        """Read the flag; its number may be given by any variable."""
        clear = self.signed and p.accept("-")
        node = p.value()
        target = resolved(node)
        return BitItem(target.index if isinstance(target, FlagNode) else node, clear)

    def evaluate(self, run: Run, read: BitItem | None) -> BitState | None:
        """The flag; a negative number that was computed also means the clear state."""
        if read is None:
            return None
        number = run.integer(read.number)
        if number < 0 and self.signed:
            return BitState(-number, not read.clear)
        return BitState(number, read.clear)


class Bits(Form):
    """One or more flags; the handler gets a tuple of `BitState`."""

    def __init__(self) -> None:
        super().__init__("bit")
        self.each = Bit()

    def starts(self, p: Parser) -> bool:
        """Whether a flag begins here."""
        return self.each.starts(p)

    def parse(self, p: Parser) -> tuple[BitItem, ...]:
        """Read as many flags as there are."""
        found = [self.each.parse(p)]
        while self.each.starts(p):
            found.append(self.each.parse(p))
        return tuple(found)

    def evaluate(self, run: Run, read: tuple[BitItem, ...]) -> tuple[BitState | None, ...]:
        """The flags."""
        return tuple(self.each.evaluate(run, item) for item in read)


class ParameterName(Form):
    """`Pnnnn` (an alias too), with `signed` also `-Pnnnn`; the handler gets `SignedParameter`."""

    def __init__(self, name: str = "Pn", *, signed: bool = False, optional: bool = False) -> None:
        super().__init__(name, optional=optional)
        self.signed = signed

    def starts(self, p: Parser) -> bool:
        """Whether a parameter begins here."""
        token = p.ahead(1) if self.signed and p.is_operator("-") else p.token
        return token.kind is Kind.WORD and (
            isinstance(p.aliases.get(token.text), ParameterNode) or token.value == "P"
        )

    def parse(self, p: Parser) -> tuple[Expr, bool]:
        """Read the parameter."""
        negative = p.accept("-")
        node = resolved(p.variable())
        if not isinstance(node, ParameterNode):
            raise p.error(SYNTAX_ERROR)
        return node.index, negative

    def evaluate(self, run: Run, read: tuple[Expr, bool] | None) -> SignedParameter | None:
        """The parameter by number."""
        return None if read is None else SignedParameter(run.integer(read[0]), read[1])


class Object(Form):
    """A word with a number, e.g. `Object("ENC", "ADC")` for `ENC0`; with `bare` a number alone.

    `singles` are words without number. The handler gets an `ObjectRef`.
    """

    def __init__(
        self, *words: str, singles: tuple[str, ...] = (), bare: str = "", optional: bool = False
    ) -> None:
        super().__init__("|".join((*words, *singles)), optional=optional)
        self.words = frozenset(words)
        self.singles = frozenset(singles)
        self.bare = bare  # the word meant by a number without word

    def starts(self, p: Parser) -> bool:
        """Whether one of the words (or a number) stands here."""
        if p.is_word(*self.singles) or (self.bare and p.at_object_index):
            return True
        return p.is_word(*self.words) and (
            p.ahead(1).kind is Kind.NUMBER or p.ahead(1).value == "("
        )

    def parse(self, p: Parser) -> tuple[str, Expr]:
        """Read word and number."""
        if self.bare and p.at_object_index:
            return self.bare, p.object_index()
        word = str(p.advance().value)
        p.names_object = True
        return word, (Number(-1) if word in self.singles else p.object_index())

    def evaluate(self, run: Run, read: tuple[str, Expr] | None) -> ObjectRef | None:
        """The object by number."""
        return None if read is None else ObjectRef(read[0], run.integer(read[1]))


class Target(Object):
    """`PROGn`, `PLCn` or `ALL`: what RUN, HALT and their kin act on."""

    def __init__(self) -> None:
        super().__init__("PROG", "PLC", singles=("ALL",), optional=True)


class Source(Object):
    """A source of pulses: NONE, CLK, ENCn, AXISn, ..., Pn or a bare parameter number."""

    WORDS = ("ENC", "STEPPER", "AXIS", "RATCH", "LIMIT", "ADC", "P")

    def __init__(self, *, optional: bool = False) -> None:
        super().__init__(*self.WORDS, singles=("NONE", "CLK", "CLOCK"), bare="P", optional=optional)


class Repeat(Form):
    """A form once or more, with `separator` between; the handler gets a tuple."""

    def __init__(self, each: Form, *, separator: str = "", optional: bool = False) -> None:
        super().__init__(each.name, optional=optional)
        self.each, self.separator = each, separator

    def starts(self, p: Parser) -> bool:
        """Whether the first one begins here."""
        return self.each.starts(p)

    def parse(self, p: Parser) -> tuple[object, ...]:
        """Read as many as there are."""
        found = [self.each.parse(p)]
        while self._goes_on(p):
            if not self.each.starts(p):
                raise p.error(self.each.missing(p))
            found.append(self.each.parse(p))
        return tuple(found)

    def _goes_on(self, p: Parser) -> bool:
        return p.accept(self.separator) if self.separator else self.each.starts(p)

    def evaluate(self, run: Run, read: tuple[object, ...] | None) -> tuple[object, ...] | None:
        """All values."""
        return None if read is None else tuple(self.each.evaluate(run, item) for item in read)


class Either(Form):
    """The first of several forms that begins at the cursor; the handler gets its value."""

    def __init__(self, *forms: Form, optional: bool = False) -> None:
        super().__init__("|".join(form.name for form in forms), optional=optional)
        self.forms = forms
        self.names_axes = any(form.names_axes for form in forms)

    def starts(self, p: Parser) -> bool:
        """Whether any of them begins here."""
        return any(form.starts(p) for form in self.forms)

    def parse(self, p: Parser) -> tuple[int, object]:
        """Read the first that fits."""
        for number, form in enumerate(self.forms):
            if form.starts(p):
                return number, form.parse(p)
        raise p.error(SYNTAX_ERROR)

    def evaluate(self, run: Run, read: tuple[int, object] | None) -> object:
        """The value of the form that was read."""
        return None if read is None else self.forms[read[0]].evaluate(run, read[1])


class Rest(Form):
    """All tokens up to the end of the block; the handler gets them as a tuple."""

    def __init__(self, name: str = "rest") -> None:
        super().__init__(name, optional=True)

    def starts(self, p: Parser) -> bool:
        """Whether anything is left."""
        return not p.at_block_end

    def parse(self, p: Parser) -> tuple[Token, ...]:
        """Take everything up to the end of the block."""
        found = []
        while not p.at_block_end:
            found.append(p.advance())
        return tuple(found)


class Command(Form):
    """A whole command, e.g. the one behind `?`; the handler gets the `Statement`."""

    def __init__(self, *, optional: bool = False) -> None:
        super().__init__("command", optional=optional)

    def starts(self, p: Parser) -> bool:
        """Whether a command word stands here."""
        return p.token.kind is Kind.WORD and p.begins_command(p.token)

    def parse(self, p: Parser) -> Statement:
        """Read the command."""
        return p.statement()
