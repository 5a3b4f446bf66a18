"""Positions formatted for the operator, in the formats of the DISPLAY tab."""

from collections.abc import Sequence
from dataclasses import dataclass

from openacr.mill.config.settings import Store
from openacr.sysvar.tabs import AXIS, CONTROL, DISPLAY
from openacr.units import MM_PER_INCH

ROTARY = frozenset("ABC")
METRIC_MODE = 21
SIGN_AND_POINT = 2


@dataclass(frozen=True, slots=True)
class Format:
    """Numbers of digits left and right of the decimal point."""

    left: int
    right: int

    @classmethod
    def of(cls, value: float) -> "Format":
        """The format encoded in a cell as digits.digits: 3.4 is three and four."""
        tenths = round(10.0 * value)
        return cls(tenths // 10, tenths % 10)

    def text(self, value: float) -> str:
        """A number padded to this format; one with more digits is shown whole, never cut."""
        width = self.left + self.right + SIGN_AND_POINT
        shown = f"{value:.{self.right}f}"
        if float(shown) == 0.0:
            shown = shown.removeprefix("-")
        return shown.rjust(width)


class Readout:
    """Positions in default units as text, in the unit of the Control Mode or in another one."""

    def __init__(self, store: Store) -> None:
        self._formats = {
            False: [Format.of(store.read(n)) for n in DISPLAY.inch_format],
            True: [Format.of(store.read(n)) for n in DISPLAY.metric_format],
        }
        self._names = [store.read_text(n) for n in AXIS.name]
        self._is_stored_metric = bool(store.read(CONTROL.default_units))
        self.is_metric = store.read(DISPLAY.control_mode) == METRIC_MODE

    def format(self, axis: int, *, is_metric: bool | None = None) -> Format:
        """The format of an axis."""
        return self._formats[self.is_metric if is_metric is None else is_metric][axis]

    def text(self, axis: int, value_u: float, *, is_metric: bool | None = None) -> str:
        """The position of an axis."""
        unit = self.is_metric if is_metric is None else is_metric
        if self._names[axis] not in ROTARY and unit != self._is_stored_metric:
            value_u *= MM_PER_INCH if unit else 1.0 / MM_PER_INCH
        return self.format(axis, is_metric=unit).text(value_u)

    def line(self, axes: Sequence[int], place: Sequence[float]) -> str:
        """The positions of several axes on one line."""
        return " ".join(f"{self._names[axis]}{self.text(axis, place[axis])}" for axis in axes)

    def place(self, axes: Sequence[int], place: Sequence[float]) -> str:
        """The positions of several axes with their unit."""
        return f"{self.line(axes, place)} {'mm' if self.is_metric else 'inch'}"
