"""The cells of a store in memory: stored values, and defaults already computed."""

from openacr.sysvar.schema import FIRST_SYSTEM
from openacr.sysvar.tabs import CONTROL
from openacr.sysvar.values import Value
from openacr.units import MM_PER_INCH

UNITS = CONTROL.default_units  # 0 inch, 1 mm


class Held:
    """Cells by number; `numbers` also holds the defaults that were computed."""

    def __init__(self) -> None:
        self.numbers: dict[int, float] = {}
        self.texts: dict[int, str] = {}
        self.stored: set[int] = set()
        self.factor = 1.0  # of lengths declared in inches
        self._defaults: set[int] = set()

    def raw(self, n: int) -> Value | None:
        """The stored value of a cell, None while it has its default."""
        if n not in self.stored:
            return None
        return self.texts[n] if n in self.texts else self.numbers[n]

    def hold(self, n: int, value: Value | None) -> None:
        """Set the stored value of a cell, None for its default."""
        if value is None:
            self._forget(n)
        else:
            self._hold_value(n, value)
        if n >= FIRST_SYSTEM:
            self._forget_defaults()

    def keep_default(self, n: int, value: float) -> float:
        """Remember the default of a cell until a system parameter changes."""
        self.numbers[n] = value
        self._defaults.add(n)
        return value

    def _hold_value(self, n: int, value: Value) -> None:
        self.stored.add(n)
        self._defaults.discard(n)
        if isinstance(value, str):
            self.texts[n] = value
        else:
            self.numbers[n] = value
        if n == UNITS:
            self.factor = MM_PER_INCH if value else 1.0

    def _forget(self, n: int) -> None:
        self.stored.discard(n)
        self._defaults.discard(n)
        self.numbers.pop(n, None)
        self.texts.pop(n, None)
        if n == UNITS:
            self.factor = 1.0

    def _forget_defaults(self) -> None:
        """Forget the computed defaults, because they may depend on system parameters."""
        for n in self._defaults:
            del self.numbers[n]
        self._defaults.clear()
