"""The values of one machine: the rows of the table, those of each axis, those the user chose."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

from openacr.bridge.moment import AxisName, Moment
from openacr.bridge.rows import AXIS_ROWS, ROWS, Kind, Row, Unit, Value
from openacr.bridge.settings import Chosen

Readings = tuple[Value, ...]  # in the order of the items


@dataclass(frozen=True, slots=True)
class Item:
    """A value of this machine: of it all, of an axis, or chosen by the user."""

    row: Row
    axis: AxisName | None = None
    place: int = 0  # of the axis
    chosen: Chosen | None = None

    @property
    def name(self) -> str:
        """The name among all values of the machine: `feed`, `X.actual`, `user.pressure`."""
        if self.axis is not None:
            return f"{self.axis.name}.{self.row.name}"
        return self.row.name if self.chosen is None else f"user.{self.row.name}"

    @property
    def unit(self) -> str:
        """The unit: millimetres of a rotary axis are degrees; a chosen value has any text."""
        if self.chosen is not None:
            return self.chosen.unit
        is_turned = self.axis is not None and self.axis.is_rotary and self.row.unit is Unit.MM
        return Unit.DEGREE if is_turned else self.row.unit

    def read(self, moment: Moment) -> Value:
        """The value at a time; None where it is not known."""
        value = self.row.read(moment, self.place)
        if isinstance(value, float) and self.axis is not None and not self.axis.is_rotary:
            return value * moment.mm_per_unit
        return value


def items_of(axes: Sequence[AxisName], chosen: Sequence[Chosen] = ()) -> tuple[Item, ...]:
    """All values of a machine with these axes."""
    return (
        *map(Item, ROWS),
        *(Item(row, axis, k) for k, axis in enumerate(axes) for row in AXIS_ROWS),
        *(Item(_row(each), chosen=each) for each in chosen),
    )


def read_all(items: Sequence[Item], moment: Moment) -> Readings:
    """The values of all items at one time."""
    return tuple(item.read(moment) for item in items)


def _row(chosen: Chosen) -> Row:
    """The row of a parameter or flag the user chose."""
    meaning, number = chosen.meaning or chosen.name, chosen.parameter_number
    if chosen.is_flag:
        return Row(chosen.name, meaning, Kind.SWITCH, partial(_flag, number, chosen.bit))
    return Row(chosen.name, meaning, Kind.NUMBER, partial(_parameter, number))


def _parameter(number: int, moment: Moment, _axis: int) -> Value:
    found = moment.watched.get(number)
    return None if moment.lost or found is None else float(found)


def _flag(number: int, bit: int, moment: Moment, _axis: int) -> Value:
    word = moment.watched.get(number)
    return None if moment.lost or word is None else bool(int(word) >> bit & 1)
