"""Parameters of programs: every number is read and written where it is kept.

Cells of the card and states of the machine can only be read at rest: an earlier read raises
`NotAtRestError`, and the caller waits and repeats it. Some numbers of the store show the
modal state where the program is read, not where the machine is.
"""

from __future__ import annotations

import math
from array import array
from collections.abc import Callable, Iterable
from typing import Protocol

from openacr.cnc.canonical import Point
from openacr.cnc.reading.findings import CodeError
from openacr.cnc.reading.formulas import LOCALS, NEAR
from openacr.cnc.reading.grammar import Grammar
from openacr.cnc.rows import values as rows
from openacr.cnc.rows.room import Memory
from openacr.cnc.state.hosts import Cells, Machine
from openacr.cnc.state.modal import Modal
from openacr.errors import MapError, OpenacrError
from openacr.sysvar.tabs import CELLS, CONTROL
from openacr.views import F64

FIRST_STORED, LAST_STORED = 100, 4095
NINTH_SYSTEM = 840  # offsets of G59.3 and its rotation
# From these cells on: whether input and output n are active when they are off.
INPUTS_INVERTED, OUTPUTS_INVERTED = CONTROL.input_inverted[0], CONTROL.output_inverted[0]
LAST_LINE = len(CONTROL.input_inverted) - 1
# Written by programs, read by the coordinates.
OFFSET_CELLS = (
    (CELLS.floating_zero_shift[0], CELLS.floating_zero_shift[-1]),
    (CELLS.common_work_shift[0], CELLS.local_shift[-1]),
    (NINTH_SYSTEM, NINTH_SYSTEM + 8),
    (CELLS.current_d_radius, CELLS.current_d_wear),
    (CELLS.current_h_length, CELLS.current_h_wear),
)
LAST_CARD = 89
FREE_CELLS = (
    (109, 233),
    (250, 270),
    (400, 799),
    (833, NINTH_SYSTEM - 1),
    (NINTH_SYSTEM + 9, 899),
    (1401, 1499),
    (1901, 1997),
    (4002, 4095),
)
OPERANDS = "read_p read_hash read_named has_named read_input read_output read_bit".split()

SHOWN: dict[int, Callable[[Modal], float]] = {
    CELLS.tool_selected: lambda m: float(m.tool),
    CELLS.tool_in_spindle: lambda m: float(m.tool_in_spindle),
    CELLS.d_number: lambda m: float(m.radius_number),
    CELLS.h_number: lambda m: float(m.length_number),
    CELLS.spindle_speed: lambda m: m.speed,
    CELLS.spindle_state: lambda m: float(m.spin.value),
    CELLS.coolant_state: lambda m: m.mist + 2.0 * m.flood,
    CELLS.unit: lambda m: float(m.unit),
    CELLS.work_system_in_use: lambda m: float(m.work),
}
FEED_CELL = CELLS.feed


class NotAtRestError(Exception):
    """A read of a value that is known only when the machine is at rest."""


class Positions(Protocol):
    """Where the program is, in the units of the program."""

    program: Point  # default units

    def shown(self, value: float) -> float:
        """A length in the active unit."""


class AccessRights(Protocol):
    """What a program may write."""

    @property
    def is_service(self) -> bool:
        """Whether system parameters may be assigned."""


class Language(Protocol):
    """The dialect, as its errors need it."""

    @property
    def grammar(self) -> Grammar:
        """Operators, keywords, comments and refusals."""


class ParameterHost(Protocol):
    """The interpreter as its parameters need it."""

    @property
    def cells(self) -> Cells:
        """The cells of the store."""

    @property
    def memory(self) -> Memory:
        """Where its numbers are."""

    @property
    def machine(self) -> Machine:
        """The machine, to be asked at rest only."""

    @property
    def modal(self) -> Modal:
        """The modal state."""

    @property
    def path(self) -> Positions:
        """Where the program is."""

    @property
    def options(self) -> AccessRights:
        """What the program may write."""

    @property
    def dialect(self) -> Language:
        """The language of the program."""

    @property
    def is_rested(self) -> bool:
        """Whether the machine is at rest."""

    def offsets_changed(self, cell: int = 0) -> None:
        """Let the program position follow offsets that were written."""


class Parameters:
    """Reads and writes by number, name or state."""

    last_local = LOCALS
    own: F64 | None = None  # numbers that are no cells, where a dialect has them

    def __init__(self, run: ParameterHost) -> None:
        self._run = run
        self._cells = run.cells
        self._modal = run.modal
        self._read_cell = run.cells.read
        # #1 to #33 of the call in force; #0, which no program can name, is 1 inside a call.
        self.values = run.memory.reals(rows.local)
        self.names: dict[str, float] = {}  # of this call
        self.global_names: dict[str, float] = {}
        self.assigned: set[int] = set()  # variables of the card the program has assigned
        self.reset()

    def reset(self) -> None:
        """A program starts: no call is in force."""
        self.values[:] = array("d", bytes(8 * len(self.values)))
        self.names = {}
        self.assigned.clear()

    @property
    def is_in_call(self) -> bool:
        """Whether #1 to #33 are locals now."""
        return self.values[0] != 0.0

    def swap(self, values: Iterable[float]) -> list[float]:
        """Replace the locals of the call; returns the previous ones."""
        kept = list(self.values)
        self.values[:] = array("d", values)
        return kept

    # --- for compiled formulas ----------------------------------------------------------

    def is_plain_cell(self, n: float, *, is_hash: bool) -> bool:
        """Whether Pn, or #n outside calls, is nothing but a cell of the store."""
        k = int(n)
        is_stored = FIRST_STORED <= k <= LAST_STORED and k == n
        return is_stored and k not in SHOWN and k != FEED_CELL

    def is_free_cell(self, n: float, *, is_hash: bool) -> bool:
        """Whether a program may write it, and nothing follows from that."""
        is_plain = self.is_plain_cell(n, is_hash=is_hash)
        return is_plain and any(first <= n <= last for first, last in FREE_CELLS)

    def is_card_cell(self, n: float, *, is_hash: bool) -> bool:
        """Whether a parameter is a variable of the card that programs may write."""
        return 0 <= n <= LAST_CARD and n == int(n)

    def read_card(self, k: int) -> float:
        """A variable of the card."""
        if not self._run.is_rested:
            raise NotAtRestError
        return self._run.machine.read_parameter(k)

    def write_card(self, k: int, value: float) -> None:
        """Set a variable of the card."""
        if not self._run.is_rested:
            raise NotAtRestError
        self.assigned.add(k)
        self._run.machine.write_parameter(k, value)

    def names_of_formulas(self) -> dict[str, object]:
        """What compiled formulas call by name."""
        return {
            "values": self.values,
            "cell": self._read_cell,
            "keep": self._cells.write,
            "write": self.write,
            "put": self.write_p,
            "wrong": _wrong,
            "rest": self.rest,
            "card": self.read_card,
            "set_card": self.write_card,
        } | {name: getattr(self, name) for name in OPERANDS}

    # --- reading ----------------------------------------------------------------------

    def read_hash(self, n: float) -> float:
        """Parameter #n: a local of the macro, or Pn."""
        if self.values[0] and 1 <= n <= LOCALS:
            return self.values[number(n)]
        return self.read_p(n)

    def read_p(self, n: float) -> float:
        """Parameter Pn."""
        k = int(n)
        if k != n:
            k = number(n)
        if FIRST_STORED <= k <= LAST_STORED and k not in SHOWN and k != FEED_CELL:
            return self._read_cell(k)
        return self._read_rare(k)

    def _read_rare(self, k: int) -> float:
        if k in SHOWN:
            return SHOWN[k](self._modal)
        if k == FEED_CELL:
            return self._run.path.shown(self._modal.feed)
        home = self._cells.home(k)
        if home.read_error:
            raise CodeError(home.read_error, 0, f"P{k}")
        if home.is_on_card:
            self.rest()
            return self._run.machine.read_parameter(k)
        try:
            return self._read_cell(k)
        except MapError:
            raise CodeError("E211", 0, f"P{k}") from None

    def rest(self) -> None:
        """Raise NotAtRestError unless the machine is at rest."""
        if not self._run.is_rested:
            raise NotAtRestError

    def read_named(self, name: str) -> float:
        """A named parameter: one that begins with `_` is global."""
        names = self.global_names if name.startswith("_") else self.names
        if name not in names:
            shown = f"#<{name}>"
            hint = self._run.dialect.grammar.refusals.of_form(shown, 1)
            raise CodeError("E211", 0, shown, hint)
        return names[name]

    def has_named(self, name: str) -> bool:
        """Whether a named parameter exists."""
        return name in (self.global_names if name.startswith("_") else self.names)

    def read_input(self, n: float) -> float:
        """The state of an input, 1 active; one that is inverted is active when it is off."""
        return float((self.read_bit(n) != 0.0) != is_inverted(self._cells, INPUTS_INVERTED, n))

    def read_output(self, n: float) -> float:
        """The state of an output, 1 active; outputs are flags from 32 on."""
        return float((self.read_bit(n) != 0.0) != is_inverted(self._cells, OUTPUTS_INVERTED, n))

    def read_bit(self, n: float) -> float:
        """The state of a card flag."""
        self.rest()
        return float(self._run.machine.read_bit(number(n)))

    def set_waited(self, value: float) -> None:
        """Show what a wait for an input found, where the dialect has a parameter for it."""

    # --- writing ----------------------------------------------------------------------

    def write(self, kind: str, n: float | str, value: float) -> None:
        """Assign `P`, `#` or a name."""
        if not math.isfinite(value):
            raise CodeError("E210")
        if isinstance(n, str):
            (self.global_names if n.startswith("_") else self.names)[n] = value
        elif kind == "#" and self.values[0] and 1 <= n <= LOCALS:
            self.values[number(n)] = value
        else:
            self.write_p(number(n), value)

    def write_p(self, k: int, value: float) -> None:
        """Assign a parameter by number."""
        home = self._cells.home(k)
        error = home.write_error(is_service=self._run.options.is_service)
        if error:
            raise CodeError(error, 0, f"P{k}")
        if home.is_on_card:
            self.write_card(k, value)
            return
        self.store(k, value)

    def store(self, k: int, value: float) -> None:
        """Write a cell of the store, and let the offsets follow."""
        try:
            self._cells.write(k, value)
        except OpenacrError as error:
            raise CodeError("E222", 0, str(error)) from None
        for first, last in OFFSET_CELLS:
            if first <= k <= last:
                self._run.offsets_changed(k)


def is_inverted(cells: Cells, first: int, n: float) -> bool:
    """Whether an input, or an output, is active when it is off; `first` says which."""
    return 0 <= n <= LAST_LINE and cells.read(first + int(n)) != 0.0


def _wrong() -> None:
    raise CodeError("E210")


def number(n: float) -> int:
    """A parameter number; E204 between two whole ones."""
    if not abs(n) < 1e9:
        raise CodeError("E211")
    k = round(n)
    if abs(k - n) > NEAR:
        raise CodeError("E204", 0, f"P{n:.10g}")
    return k
