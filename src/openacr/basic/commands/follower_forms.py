"""Arguments of gears, cams and objects: arrays by name, triggers, segments."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

from msgspec import Struct

from openacr.basic.language.grammar import (
    Axis,
    AxisList,
    Form,
    Int,
    Num,
    ObjectRef,
    ParameterName,
    Source,
)
from openacr.basic.language.nodes import Expr
from openacr.basic.vm.run import Run
from openacr.errors import CardError
from openacr.lang.lexer import LONG_LIMIT
from openacr.map.kinds_cy import kind_of
from openacr.map.numbers import KIND_LONG, KIND_NONE
from openacr.messages import INVALID_ARGUMENT, INVALID_PARAMETER
from openacr.motion.sources import sources

if TYPE_CHECKING:
    from openacr.basic.language.parser import Parser

LAST_CAPTURE_MODE = 15
LAST_CAPTURE_REGISTER = 15  # of encoders that have a marker and inputs
CaptureRead: TypeAlias = "tuple[Expr, tuple[Expr, bool] | None, Expr | None]"


class Passing(Struct, frozen=True):
    """A parameter passing a setpoint, upwards or `below`; a timeout of 0 never expires."""

    parameter: int
    setpoint: float
    below: bool
    timeout_s: float


class Captured(Struct, frozen=True):
    """The edge of a capture mode; `copy_to` is a parameter, 0 none.

    `register` is the encoder whose marker and inputs are watched, None that of the source.
    """

    mode: int
    copy_to: int = 0
    register: int | None = None


class Segment(Struct, frozen=True):
    """One segment of a table."""

    number: int
    length_cnt: float
    array: int


class ArrayName(Form):
    """`LAx` (or another array word): a whole array; the handler gets an `ObjectRef`."""

    def __init__(self, *words: str, optional: bool = False) -> None:
        super().__init__("|".join(f"{word}n" for word in words), optional=optional)
        self.words = frozenset(words)

    def starts(self, p: Parser) -> bool:
        """Whether such a word stands here."""
        return p.cursor.is_word(*self.words)

    def parse(self, p: Parser) -> tuple[str, Expr]:
        """Read word and number."""
        return str(p.cursor.advance().value), p.expressions.object_index()

    def evaluate(self, run: Run, read: tuple[str, Expr] | None) -> ObjectRef | None:
        """The array by number."""
        return None if read is None else ObjectRef(read[0], run.integer(read[1]))


class PassingForm(Form):
    """`(Pnnnn|-Pnnnn, setpoint {, timeout})`; the handler gets a `Passing`."""

    def __init__(self) -> None:
        super().__init__("(Pnnnn|-Pnnnn, setpoint{, timeout})")
        self.parameter = ParameterName(signed=True)

    def starts(self, p: Parser) -> bool:
        """Whether a parenthesis stands here."""
        return p.cursor.is_operator("(")

    def parse(self, p: Parser) -> tuple[tuple[Expr, bool], Expr, Expr | None]:
        """Read the three."""
        p.cursor.expect("(")
        if not self.parameter.starts(p):
            raise p.cursor.error(self.missing(p))
        parameter = self.parameter.parse(p)
        p.cursor.expect(",")
        setpoint = p.expressions.numeric()
        timeout = p.expressions.numeric() if p.cursor.accept(",") else None
        p.cursor.expect(")")
        return parameter, setpoint, timeout

    def evaluate(
        self, run: Run, read: tuple[tuple[Expr, bool], Expr, Expr | None]
    ) -> Passing | None:
        """Parameter, setpoint and timeout."""
        parameter, setpoint, timeout = read
        found = self.parameter.evaluate(run, parameter)
        if found is None:
            return None
        needs_parameter(run, found.number)
        seconds = 0.0 if timeout is None else run.value(timeout)
        if seconds < 0.0 or run.card.clock.ticks(seconds) > LONG_LIMIT:
            raise CardError(INVALID_ARGUMENT)
        return Passing(found.number, run.value(setpoint), found.negative, seconds)


class CapturedForm(Form):
    """`(mode {, Pnnnn|register})`, or without registers; the handler gets a `Captured`."""

    def __init__(self, *, has_registers: bool = True) -> None:
        super().__init__(f"(mode{{, Pnnnn{'|register' if has_registers else ''}}})")
        self.has_registers = has_registers
        self.mode = Int("mode", 0, LAST_CAPTURE_MODE)
        self.copy = ParameterName()
        self.register = Int("register", 0, LAST_CAPTURE_REGISTER)

    def starts(self, p: Parser) -> bool:
        """Whether a parenthesis stands here."""
        return p.cursor.is_operator("(")

    def parse(self, p: Parser) -> CaptureRead:
        """Read mode and parameter or register."""
        p.cursor.expect("(")
        mode = p.expressions.numeric()
        copy, register = None, None
        if p.cursor.accept(","):
            if self.copy.starts(p) or not self.has_registers:
                copy = self.copy.parse(p)
            else:
                register = p.expressions.numeric()
        p.cursor.expect(")")
        return mode, copy, register

    def evaluate(self, run: Run, read: CaptureRead) -> Captured:
        """Mode and parameter or register by number."""
        mode = self.mode.evaluate(run, read[0]) or 0
        if read[2] is not None:
            return Captured(mode, register=self.register.evaluate(run, read[2]))
        copy = self.copy.evaluate(run, read[1])
        if copy is None:
            return Captured(mode)
        needs_long(run, copy.number)
        return Captured(mode, copy.number)


class SegmentForm(Form):
    """`(segment, length, LAx)`; the handler gets a `Segment`."""

    def __init__(self) -> None:
        super().__init__("(segment, length, LAn)")
        self.number = Int("segment", 0)
        self.length = Num("length")
        self.array = ArrayName("LA")

    def starts(self, p: Parser) -> bool:
        """Whether a parenthesis stands here."""
        return p.cursor.is_operator("(")

    def parse(self, p: Parser) -> tuple[Expr, Expr, tuple[str, Expr]]:
        """Read the three."""
        p.cursor.expect("(")
        number = p.expressions.numeric()
        p.cursor.expect(",")
        length = p.expressions.numeric()
        p.cursor.expect(",")
        if not self.array.starts(p):
            raise p.cursor.error(self.missing(p))
        array = self.array.parse(p)
        p.cursor.expect(")")
        return number, length, array

    def evaluate(self, run: Run, read: tuple[Expr, Expr, tuple[str, Expr]]) -> Segment:
        """The numbers."""
        number = self.number.evaluate(run, read[0]) or 0
        return Segment(number, run.value(read[1]), run.integer(read[2][1]))


class AxisSources(AxisList):
    """`axis {source}...`; without a source a query."""

    def __init__(self) -> None:
        super().__init__(Source(optional=True))


def needs_parameter(run: Run, number: int) -> None:
    """`Invalid parameter` for one that is not defined."""
    if kind_of(run.card.memory.I, number) == KIND_NONE:
        raise CardError(INVALID_PARAMETER)


def needs_long(run: Run, number: int) -> None:
    """Positions are pulses: they are copied to LONG parameters."""
    if kind_of(run.card.memory.I, number) != KIND_LONG:
        raise CardError(INVALID_PARAMETER)


def choose_sources(run: Run, axes: tuple[tuple[Axis, ObjectRef | None], ...], use: int) -> None:
    """Give axes their sources, or none if one does not exist; report those without one."""
    for _, source in axes:
        if source is not None:
            sources.check(run.card, source.word, source.number)
    for axis, source in axes:
        tap = sources.axis_tap(axis.number, use)
        if source is None:
            run.print(sources.text(run.card, tap))
        else:
            sources.go_live(run.card, axis.number)
            sources.choose(run.card, tap, source.word, source.number)


def choose_object_source(run: Run, tap: int, source: ObjectRef | None) -> None:
    """Give an object its source, or report it."""
    if source is None:
        run.print(sources.text(run.card, tap))
        return
    sources.check(run.card, source.word, source.number)
    sources.objects_go_live(run.card)
    sources.choose(run.card, tap, source.word, source.number)
