"""The observations an agent keeps, by sequence number, and the state at any of them."""

from collections import deque
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from openacr.bridge.mtconnect.model import Category, DataItem
from openacr.bridge.rows import Value, alarms_of


@dataclass(frozen=True, slots=True)
class Observation:
    """One observation; an alarm makes it one of a condition."""

    sequence: int
    stamp: str
    item: DataItem
    text: str
    level: str = ""  # of a condition: Normal, Warning, Fault, Unavailable
    code: str = ""  # native code of a condition


State = dict[str, list[Observation]]  # by id of the data item; of a condition all active ones


class OutOfRangeError(Exception):
    """A sequence number that is not in the buffer."""


class Buffer:
    """The last observations. Sequence numbers begin with 1 and never repeat."""

    def __init__(self, items: Sequence[DataItem], size: int, stamp: str) -> None:
        self.size = size
        self._items = items
        self._kept: deque[Observation] = deque()
        self._values: list[Value] = [None] * len(items)
        self._first_state: State = {}  # before the first observation that is kept
        self._state: State = {}
        self._next = 1
        for item in items:
            if item.category is Category.CONDITION:
                self._note(item, stamp, "", level="Unavailable")
            else:
                self._note(item, stamp, item.text(None))

    @property
    def first(self) -> int:
        """The sequence number of the oldest observation that is kept."""
        return self._next - len(self._kept)

    @property
    def last(self) -> int:
        """The sequence number of the newest observation."""
        return self._next - 1

    @property
    def next(self) -> int:
        """The sequence number that the next observation gets."""
        return self._next

    def put(self, changes: Iterable[tuple[int, Value]], stamp: str) -> None:
        """Note new values of data items, by their places."""
        for place, value in changes:
            item, before = self._items[place], self._values[place]
            if value == before:
                continue
            self._values[place] = value
            if item.category is Category.CONDITION:
                self._note_alarms(item, stamp, before, value)
            else:
                self._note(item, stamp, item.text(value))

    def note_asset(self, place: int, name: str, stamp: str) -> None:
        """Note that the asset of an id was changed or removed, although it was the last one too."""
        self._values[place] = name
        self._note(self._items[place], stamp, name)

    def value(self, place: int) -> Value:
        """The newest value of a data item, by its place."""
        return self._values[place]

    def _note_alarms(self, item: DataItem, stamp: str, before: Value, now: Value) -> None:
        """An alarm that is gone becomes normal by its code; without alarms the item is normal."""
        if not isinstance(now, tuple):
            self._note(item, stamp, "", level="Unavailable")
            return
        alarms, old = alarms_of(now), alarms_of(before)
        gone = [alarm for alarm in old if alarm not in alarms]
        if not now:
            self._note(item, stamp, "", level="Normal")
            return
        codes = {alarm.code for alarm in alarms}
        for alarm in gone:
            if alarm.code not in codes:
                self._note(item, stamp, "", level="Normal", code=str(alarm.code))
        for alarm in alarms:
            if alarm not in old:
                level = "Warning" if alarm.is_mild else "Fault"
                self._note(item, stamp, alarm.text, level=level, code=str(alarm.code))

    def _note(
        self, item: DataItem, stamp: str, text: str, *, level: str = "", code: str = ""
    ) -> None:
        found = Observation(self._next, stamp, item, text, level, code)
        self._next += 1
        self._kept.append(found)
        _apply(self._state, found)
        if len(self._kept) > self.size:
            _apply(self._first_state, self._kept.popleft())

    # --- reading ----------------------------------------------------------------------

    def state(self, at: int | None = None) -> list[Observation]:
        """The newest observation of each data item, as of a sequence number; OutOfRangeError."""
        if at is None:
            return [each for found in self._state.values() for each in found]
        if not self.first <= at <= self.last:
            raise OutOfRangeError(f"'at' must be within {self.first} and {self.last}")
        state = {key: list(found) for key, found in self._first_state.items()}
        for place in range(at - self.first + 1):
            _apply(state, self._kept[place])
        return [each for found in state.values() for each in found]

    def part(
        self, begin: int | None, count: int, wanted: frozenset[str] | None = None
    ) -> tuple[list[Observation], int]:
        """Observations from a sequence number on, and the next one to ask for.

        A negative count goes back from there. OutOfRangeError for a number that is not kept; the
        next number, whose observation is still to come, is allowed.
        """
        is_back = count < 0
        start = begin if begin is not None else (self.last if is_back else self.first)
        if not self.first <= start <= self._next:
            raise OutOfRangeError(f"'from' must be within {self.first} and {self._next}")
        found: list[Observation] = []
        step = -1 if is_back else 1
        place = start - self.first
        while 0 <= place < len(self._kept) and len(found) < abs(count):
            each = self._kept[place]
            if wanted is None or each.item.id in wanted:
                found.append(each)
            place += step
        if is_back:
            return found, max(self.first, self.first + place)
        return found, self.first + place


def _apply(state: State, each: Observation) -> None:
    """Make the state that follows from one more observation."""
    key = each.item.id
    if each.item.category is not Category.CONDITION or not each.code:
        state[key] = [each]
        return
    others = [o for o in state.get(key, []) if o.code and o.code != each.code]
    state[key] = others if each.level == "Normal" else [*others, each]
