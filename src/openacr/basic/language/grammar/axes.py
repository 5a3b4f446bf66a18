"""Forms of axes with values, and of the targets of moves."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from msgspec import Struct

from openacr.basic.language.form import Form
from openacr.basic.language.grammar.forms import Group, Num, Pair
from openacr.basic.language.grammar.values import AxisTarget, AxisValue
from openacr.basic.language.nodes import AxisRef, Expr
from openacr.lang.lexer import TokenKind
from openacr.messages import SYNTAX_ERROR, UNDEFINED_SYMBOL, Message

if TYPE_CHECKING:
    from openacr.basic.language.parser import Parser
    from openacr.basic.vm.run import Run


class AxisItem(Struct, frozen=True):
    """An axis as written, with the argument that follows it."""

    axis: AxisRef
    argument: object = None


class AxisList(Form):
    """`axis argument axis argument ...`, or the argument alone after the prefix `AXISn`.

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
        """An unknown word is an undefined symbol."""
        return UNDEFINED_SYMBOL if p.at_unknown_word else SYNTAX_ERROR

    def parse(self, p: Parser) -> tuple[AxisItem, ...]:
        """Read as many axes as there are."""
        if p.prefix is not None:
            return (AxisItem(AxisRef("AXIS", p.prefix.number), self._argument(p)),)
        found = [AxisItem(p.axis(), self._argument(p))]
        while p.at_axis and not self._begins_statement(p):
            found.append(AxisItem(p.axis(), self._argument(p)))
        if p.at_unknown_word:
            raise p.cursor.error(UNDEFINED_SYMBOL)
        return tuple(found)

    def _begins_statement(self, p: Parser) -> bool:
        """Whether `AXISn` here is the prefix of a new command, as in `PPU X 1 AXIS1 ON`."""
        following = p.cursor.ahead(2)
        return (
            p.cursor.is_word("AXIS")
            and p.cursor.ahead(1).kind is TokenKind.NUMBER
            and following.kind is TokenKind.WORD
            and following.value != "AXIS"
            and p.begins_command(following)
        )

    def _argument(self, p: Parser) -> object:
        if self.each is None:
            return None
        if self.each.starts(p):
            return self.each.parse(p)
        if self.each.optional:
            return None
        raise p.cursor.error(SYNTAX_ERROR)

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


class TargetItem(Struct, frozen=True):
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
        return p.at_axis and not p.cursor.is_word("AXIS")

    def missing(self, p: Parser) -> Message:
        """An unknown axis is an undefined symbol."""
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
                raise p.cursor.error(SYNTAX_ERROR)
            return TargetItem(axis, self.group.parse(p), False)
        incremental = p.cursor.accept("/")
        return TargetItem(axis, (p.expressions.value(),), incremental)

    def evaluate(self, run: Run, read: tuple[TargetItem, ...] | None) -> Any:
        """The targets."""
        if read is None:
            return None
        return tuple(
            AxisTarget(run.axis(item.axis), tuple(map(run.value, item.values)), item.incremental)
            for item in read
        )
