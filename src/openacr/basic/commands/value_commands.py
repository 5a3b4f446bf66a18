"""Commands that set a value and report it when it is left out, made from one row each.

A row names the words, the place of the value (`motion.settings.Setting`), its unit, its
default and what it means; level, argument form, checks, report text and the help line
follow from the kind of the row.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from msgspec import Struct

from openacr.basic.language.grammar import Axis, AxisPairs, AxisValue, AxisValues, Num
from openacr.basic.language.number_format import NumberKind, number_text
from openacr.basic.language.registry import ANY, BY_OBJECT, Level, command
from openacr.basic.memory.saving import keep
from openacr.basic.vm.run import Run
from openacr.errors import CardError
from openacr.messages import INVALID_ARGUMENT
from openacr.models import Feature
from openacr.motion.axis.settings import Place, Setting
from openacr.motion.card import Card


class Value(Struct, frozen=True):
    """A command of one number per axis or master."""

    words: str
    setting: Setting
    doc: str
    units: str = ""
    default: str = "0"
    saved: bool = True
    then: Callable[[Card, int], None] | None = None  # after a value was stored
    factor: float = 1.0  # what is written per what is stored
    bare: bool = False  # without axis it reports all axes of the program

    def text(self, card: Card, number: int) -> str:
        """What the query prints."""
        return value_text(self.setting, self.setting.read(card, number) * self.factor)

    def write(self, card: Card, number: int, value: float) -> None:
        """Store a value given by the user."""
        self.setting.write(card, number, value / self.factor)
        if self.then is not None:
            self.then(card, number)


class Band(Struct, frozen=True):
    """A command of two numbers per axis: `v` means plus v and minus -v."""

    words: str
    plus: Setting
    minus: Setting
    doc: str
    units: str
    default: str = "0,0"

    def text(self, card: Card, number: int) -> str:
        """What the query prints."""
        ends = (self.plus, self.minus)
        return ",".join(value_text(end, end.read(card, number)) for end in ends)

    def write(self, card: Card, number: int, plus: float, minus: float) -> None:
        """Store both ends."""
        self.plus.check(plus)
        self.minus.write(card, number, minus)
        self.plus.write(card, number, plus)


class ObjectValue(Struct, frozen=True):
    """A command of one number per numbered object, e.g. `DAC # GAIN`."""

    words: str
    setting: Setting
    count: Callable[[Card], int]
    doc: str
    units: str = ""
    default: str = "0"


def value_text(setting: Setting, value: float) -> str:
    """The text of a value as its kind is printed."""
    return number_text(value, NumberKind(setting.kind.value))


def put(
    row: Value | Band | ObjectValue,
    handler: Callable[..., Any],
    *forms: Any,
    group: str,
    ref: str,
    levels: Level,
    saved: bool,
    needs: Feature = Feature.NONE,
) -> None:
    """Enter the handler made for a row."""
    handler.__doc__ = row.doc
    command(
        row.words,
        group=group,
        levels=levels,
        grammar=forms,
        ref=ref,
        units=row.units,
        default=row.default,
        saved=saved,
        needs=needs,
    )(handler)


def axis_values(rows: Iterable[Value], *, group: str, ref: str) -> None:
    """Register commands `WORD axis {value}...`."""
    for row in rows:
        form = AxisValues(optional=row.bare)
        handler = _axis_value(row)
        put(row, handler, form, group=group, ref=ref, levels=BY_OBJECT, saved=row.saved)
        if row.saved:
            keep(row.words, row.setting, count=_axes, then=row.then)


def _axes(card: Card) -> int:
    return card.model.axes


def _masters(card: Card) -> int:
    return card.model.masters


def _axis_value(row: Value) -> Callable[..., None]:
    def handler(run: Run, axes: tuple[AxisValue, ...] | None) -> None:
        if axes is None:
            report_all(run, lambda axis: row.text(run.card, axis.number))
            return
        check_all(axes, row.setting)
        for item in axes:
            if item.is_query:
                run.print(row.text(run.card, item.axis.number))
            else:
                row.write(run.card, item.axis.number, item.value)

    return handler


def value_elsewhere(
    words: str, place: Callable[[Card, int], Place], doc: str, *, default: str, group: str, ref: str
) -> None:
    """Register `WORD axis {value}...` for values that lie where `place` finds them for an axis."""

    def handler(run: Run, axes: tuple[AxisValue, ...]) -> None:
        items = [(item, *place(run.card, item.axis.number)) for item in axes]
        for item, setting, _ in items:
            check_all((item,), setting)
        for item, setting, number in items:
            if item.is_query:
                run.print(value_text(setting, setting.read(run.card, number)))
            else:
                setting.write(run.card, number, item.value)

    handler.__doc__ = doc
    form = AxisValues()
    command(
        words, group=group, levels=BY_OBJECT, grammar=(form,), ref=ref, default=default, saved=True
    )(handler)


def check_all(axes: Iterable[AxisValue], setting: Setting) -> None:
    """Refuse a statement before any of its values is stored."""
    for item in axes:
        for value in item.values:
            setting.check(value)


def report_all(run: Run, text: Callable[[Axis], str]) -> None:
    """One line per axis of the program, each with the name of the axis."""
    for axis in run.axes():
        run.print(f"{axis.name} {text(axis)}")


def axis_bands(rows: Iterable[Band], *, group: str, ref: str) -> None:
    """Register commands `WORD axis {v | (plus,minus)}...`."""
    for row in rows:
        handler = _axis_band(row)
        put(row, handler, AxisPairs(), group=group, ref=ref, levels=BY_OBJECT, saved=True)
        keep(row.words, row.plus, row.minus, count=_axes)


def _axis_band(row: Band) -> Callable[..., None]:
    def handler(run: Run, axes: tuple[AxisValue, ...]) -> None:
        check_all(axes, row.plus)
        for item in axes:
            if item.is_query:
                run.print(row.text(run.card, item.axis.number))
            else:
                plus, minus = item.values
                row.write(run.card, item.axis.number, plus, minus)

    return handler


def master_values(
    rows: Iterable[Value], *, group: str, ref: str, needs: Feature = Feature.NONE
) -> None:
    """Register commands `WORD {value}` of the program's master or that of `MASTERm`."""
    for row in rows:
        form = Num("value", optional=True)
        handler = _master_value(row)
        kept = row.saved
        put(row, handler, form, group=group, ref=ref, levels=BY_OBJECT, saved=kept, needs=needs)
        if row.saved:
            keep(row.words, row.setting, count=_masters, then=row.then)


def _master_value(row: Value) -> Callable[..., None]:
    def handler(run: Run, value: float | None) -> None:
        master = run.master()
        if value is None:
            run.print(row.text(run.card, master))
        else:
            row.write(run.card, master, value)

    return handler


def object_values(rows: Iterable[ObjectValue], *, group: str, ref: str) -> None:
    """Register commands `WORD # DAUGHTER {value}`, valid at every level."""
    for row in rows:
        form = Num("value", optional=True)
        put(row, _object_value(row), form, group=group, ref=ref, levels=ANY, saved=True)
        keep(row.words, row.setting, count=row.count)


def _object_value(row: ObjectValue) -> Callable[..., None]:
    def handler(run: Run, number: int, value: float | None) -> None:
        check_number(number, row.count(run.card))
        if value is None:
            run.print(value_text(row.setting, row.setting.read(run.card, number)))
        else:
            row.setting.write(run.card, number, value)

    return handler


def check_number(number: int, count: int) -> None:
    """`Invalid argument` for an object the card does not have."""
    if not 0 <= number < count:
        raise CardError(INVALID_ARGUMENT)
