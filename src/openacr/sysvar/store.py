"""The store as programs use it: numbered cells, read from memory, written through at once.

    with Store(path) as store:
        feed = store.read(SPEEDS.cut_speed)
        with store.transaction():          # all of it is stored, or nothing
            store.write(CELLS.h_length[1], 1.5)
            store.write(CELLS.h_wear[1], 0.01)

A read is a dictionary access: cells are kept in memory, and a counter shared by all
processes shows when they have to be read again. A value written by another process is seen
at the next read.
"""

import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import RLock
from typing import NamedTuple

from openacr.closing import Closing
from openacr.errors import MapError, StoreError
from openacr.sysvar import lookup, rules, values
from openacr.sysvar.counter import ASK, SIZE, Counter, is_settled
from openacr.sysvar.database import Database
from openacr.sysvar.driven import is_driven
from openacr.sysvar.held import UNITS, Held
from openacr.sysvar.homes import Home, home_of
from openacr.sysvar.schema import FIRST_SYSTEM, At, Parameter
from openacr.sysvar.tabs import AXIS, CELLS
from openacr.sysvar.values import SettingError, Value
from openacr.units import MM_PER_INCH

POLL_S = 0.05  # longest time without asking the database itself
NEVER = b""  # equals no state of the counter
# The state at the start of the front end: no offset in use, spindle off, idle.
AT_START = {
    CELLS.current_d_radius: 0.0,
    CELLS.current_d_wear: 0.0,
    CELLS.current_h_length: 0.0,
    CELLS.current_h_wear: 0.0,
    CELLS.spindle_state: 5.0,
    CELLS.coolant_state: 0.0,
    CELLS.run_state: 0.0,
}

Listener = Callable[[frozenset[int]], None]


class Changes(NamedTuple):
    """The cells that were written, and the token with which to ask for the next ones."""

    numbers: frozenset[int]
    token: int


class Store(Closing):
    """The SYSVAR store in a file, or in memory without a path.

    A missing file is created; `is_metric` applies to a new one only: the defaults of lengths
    are then millimetres.
    """

    def __init__(self, path: Path | str | None = None, *, is_metric: bool = False) -> None:
        self.path = None if path is None else Path(path)
        self._lock = RLock()
        self._counter = Counter(self.path)
        self._memory = self._counter.memory
        self._seen = NEVER
        self._until = 0.0
        self._held = Held()
        self._numbers = self._held.numbers
        self._before: dict[int, Value | None] = {}  # previous values, for a rollback
        self._depth = 0
        self._token = 0
        self._version = -1
        self._listeners: list[Listener] = []
        try:
            self._database = Database(self.path, is_used=self._counter.has_counted)
        except BaseException:
            self._counter.close()
            raise
        try:
            self._poll_database()
        except BaseException:
            self.close()
            raise
        if is_metric and not self._token:
            self.begin_metric()

    def close(self) -> None:
        """Close the file; everything written is in it."""
        self._database.close()
        self._counter.close()
        self._memory = ASK

    @property
    def is_read_only(self) -> bool:
        """Whether the file cannot be written."""
        return self._database.is_read_only

    # --- reading ----------------------------------------------------------------------

    def read(self, n: int) -> float:
        """The number in a cell."""
        if self._memory[:SIZE] != self._seen or time.monotonic() > self._until:
            self._poll_database()
        try:
            return self._numbers[n]
        except KeyError:
            return self._first_number(n)

    @staticmethod
    def home(n: int) -> Home:
        """Where a number is kept (store or card), and who may use it."""
        return home_of(n)

    def read_text(self, n: int) -> str:
        """The text in a cell."""
        self._refresh()
        found = self._held.texts.get(n)
        return self._first_text(n) if found is None else found

    def value(self, n: int) -> Value:
        """The number or text in a cell."""
        return self.read_text(n) if self.parameter(n).is_text else self.read(n)

    def default(self, n: int) -> Value:
        """The value of a cell until one is written."""
        parameter = self.parameter(n)
        first = parameter.row.default
        if callable(first):
            return first(At(parameter.axis or 0, parameter.index, self.read))
        if isinstance(first, str):
            return first
        if parameter.is_length:
            return values.scaled(
                parameter, float(first), self._held.factor, self.letter_of(parameter)
            )
        return float(first)

    def is_set(self, n: int) -> bool:
        """Whether a value was written, even one equal to the default."""
        self._refresh()
        return n in self._held.stored

    def parameter(self, n: int) -> Parameter:
        """The description of a cell; MapError if there is no such cell."""
        return lookup.known(n)

    def find(self, text: str) -> list[Parameter]:
        """The cells a number, a tab or words of a name match; MapError if none does."""
        return lookup.find(text)

    @property
    def is_metric(self) -> bool:
        """Whether lengths are in millimetres."""
        return self.read(UNITS) == 1.0

    def letter_of(self, parameter: Parameter) -> str:
        """The name of the axis in whose unit a cell is, empty if that of no one axis."""
        if parameter.axis is None or parameter.row.is_of_tool:
            return ""
        if parameter.number == AXIS.name[parameter.axis]:
            return ""
        return self.read_text(AXIS.name[parameter.axis])

    def _first_number(self, n: int) -> float:
        parameter = self.parameter(n)
        if parameter.is_text:
            raise MapError(f"{parameter} holds text")
        with self._lock:  # a write of another thread may change what the default depends on
            return self._held.keep_default(n, float(self.default(n)))

    def _first_text(self, n: int) -> str:
        parameter = self.parameter(n)
        if not parameter.is_text:
            raise MapError(f"{parameter} holds a number")
        return str(self.default(n))

    # --- writing ----------------------------------------------------------------------

    def write(self, n: int, value: float) -> None:
        """Set a number; outside a transaction it is stored before this returns."""
        self._set(n, value)

    def write_text(self, n: int, value: str) -> None:
        """Set a text, as `write` sets a number."""
        self._set(n, value)

    def reset(self, n: int) -> None:
        """Set a cell back to its default."""
        with self.transaction():
            if n in self._held.stored:
                self._set_held(n, None)

    @contextmanager
    def transaction(self, *, is_durable: bool = True) -> Iterator[None]:
        """A group of changes: all of them are stored, or none.

        Reads inside it return the new values. `is_durable` waits until they are on the disk:
        without it nothing is lost when the process ends, but a power cut may lose the last
        changes.
        """
        foreign: frozenset[int] = frozenset()
        changed: frozenset[int] = frozenset()
        try:
            with self._lock:
                if self._depth:
                    yield
                    return
                foreign = self._begin(is_durable)
                try:
                    yield
                    self._commit()
                    changed = frozenset(self._before)
                except BaseException:
                    self._roll_back()
                    raise
                finally:
                    self._depth = 0
                    self._before = {}
        finally:
            self._notify(foreign)
            self._notify(changed)

    def begin_metric(self) -> None:
        """Make an empty store metric: the defaults of its lengths are then in millimetres."""
        with self.transaction():
            if not self._token:
                self._set_held(UNITS, 1.0)

    def flush(self) -> None:
        """Wait until everything written is on the disk."""
        self._database.flush()

    def _set(self, n: int, value: Value) -> None:
        parameter = self.parameter(n)
        if parameter.row.is_fixed:
            raise SettingError(parameter, value, "it is read-only")
        is_metric, letter = self._held.factor != 1.0, self.letter_of(parameter)
        new = values.checked(parameter, value, is_metric, letter)
        self._refresh()
        if n in self._held.stored and new == self._held.raw(n):
            return
        with self.transaction(is_durable=n >= FIRST_SYSTEM):
            if n == UNITS and new != self.read(UNITS):
                self._convert(MM_PER_INCH if new else 1.0 / MM_PER_INCH)
            self._set_held(n, new)

    def _set_held(self, n: int, value: Value | None) -> None:
        self._remember_before(n)
        self._held.hold(n, value)

    def _convert(self, factor: float) -> None:
        """Convert all stored lengths to the other unit; the machine stays the same."""
        for parameter in lookup.parameters():
            n = parameter.number
            if parameter.is_per_length or (parameter.is_length and n in self._held.stored):
                letter = self.letter_of(parameter)
                self._set_held(n, values.scaled(parameter, self.read(n), factor, letter))

    # --- transactions -----------------------------------------------------------------

    def _begin(self, is_durable: bool) -> frozenset[int]:
        """Start a transaction; returns the cells other processes wrote since the last poll."""
        self._database.begin(is_durable=is_durable)
        try:
            foreign = self._apply_rows(self._database.since(self._token))
        except BaseException:
            self._database.rollback()
            raise
        self._depth = 1
        self._before = {}
        self._was_running = self._numbers.get(rules.RUN_STATE, 0.0) in rules.RUNNING
        return foreign

    def _commit(self) -> None:
        if not self._before:
            self._database.rollback()
            return
        rules.check(self, self._before, self._is_running)
        token = self._token + 1  # all before it was read when the transaction began
        self._database.write_rows((n, self._held.raw(n), token) for n in self._before)
        self._counter.begin()
        try:
            self._database.commit()
        finally:
            self._counter.end()
        self._token = token
        self._seen = NEVER

    def _is_running(self) -> bool:
        """Whether a program runs: a killed one leaves its state in P244, but not its lock."""
        return self._was_running and is_driven(self.path)

    def _roll_back(self) -> None:
        self._database.rollback()
        for n, value in self._before.items():
            self._held.hold(n, value)
        self._before = {}

    def _remember_before(self, n: int) -> None:
        """Remember the value of a cell from before this transaction."""
        if n not in self._before:
            self._before[n] = self._held.raw(n)

    # --- other processes --------------------------------------------------------------

    def _refresh(self) -> None:
        if self._memory[:SIZE] != self._seen or time.monotonic() > self._until:
            self._poll_database()

    def _poll_database(self) -> None:
        """Ask the database whether another process has written, and read what it wrote."""
        with self._lock:
            if self._depth:
                return
            stamp = self._memory[:SIZE]  # first: changes from now on count again
            version = self._database.version()
            changed: frozenset[int] = frozenset()
            if version != self._version:
                changed = self._apply_rows(self._database.since(self._token))
                self._version = version
            self._seen = stamp if is_settled(stamp) else NEVER
            self._until = time.monotonic() + POLL_S
        self._notify(changed)

    def _apply_rows(self, rows: Iterable[tuple[int, Value | None, int]]) -> frozenset[int]:
        changed = set()
        for n, value, token in rows:
            self._held.hold(n, None if value is None else _of_the_kind(n, value))
            self._token = max(self._token, token)
            changed.add(n)
        return frozenset(changed)

    # --- changes -------------------------------------------------------------------------

    @property
    def token(self) -> int:
        """The state of the store now, for `changes_since`."""
        self._refresh()
        return self._token

    def changes_since(self, token: int) -> Changes:
        """The cells written by any process after `token`."""
        self._refresh()
        rows = self._database.since(token)
        return Changes(
            frozenset(n for n, _, _ in rows), max((row[2] for row in rows), default=token)
        )

    def subscribe(self, listener: Listener) -> Callable[[], None]:
        """Call `listener` with the numbers of changed cells; call the result to end that.

        Changes of other processes are noticed when a cell is read, or by `poll`.
        """
        self._listeners.append(listener)
        return lambda: self._listeners.remove(listener)

    def poll(self) -> None:
        """Read the changes of other processes, and notify the listeners."""
        self._poll_database()

    def _notify(self, changed: frozenset[int]) -> None:
        if changed:
            for listener in tuple(self._listeners):
                listener(changed)


def _of_the_kind(n: int, value: Value) -> Value:
    """A stored value as number or text; StoreError if the cell is of the other kind."""
    parameter = lookup.parameter(n)
    if isinstance(value, str) and (parameter is None or parameter.is_text):
        return value
    if isinstance(value, int | float) and (parameter is None or not parameter.is_text):
        return float(value)
    raise StoreError(f"the store holds {value!r} for {parameter}, which is of another type")
