"""The gains that each axis has had since the panel began: any of these sets can be set again.

They are read from the card, so that what another host, a program or the set-up has changed is
among them, too.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Literal

from openacr.client.values import number_text
from openacr.errors import UserError
from openacr.mill.session import MillSession
from openacr.tuning import settings as tuned
from openacr.tuning.filters import FILTERS, Filters
from openacr.tuning.measure import settings_of

MOST = 200  # sets of an axis; the first one is kept
FP32_DIGITS = 7
SAME_S = 2.0  # changes of one gain that follow each other sooner are one: a slider is moved
FILTER_WORDS = ("LOPASS", "NOTCH")
By = Literal["start", "here", "elsewhere"]
Rows = tuple[float, ...]
Changed = tuple[str, float | str, float | str]  # word, before, after


@dataclass(frozen=True, slots=True)
class GainSet:
    """The gains and filters of an axis from a moment on; filters None: written by hand."""

    number: int
    before: int  # the number of the set that was in force before; 0: none
    at_s: float
    by: By
    rows: Rows  # of the card: gains, then coefficients of the filters
    filters: Filters | None
    changed: tuple[Changed, ...] = ()  # of the set before

    @property
    def gains(self) -> dict[str, float]:
        """The gains by their words."""
        return dict(zip(tuned.GAINS, self.rows, strict=False))

    @property
    def values(self) -> dict[str, float | str]:
        """Gains and filters by their words."""
        return {**self.gains, **_filter_texts(self.filters)}


class GainSets:
    """The sets of gains of one card, axis by axis."""

    def __init__(self) -> None:
        self._sets: dict[int, list[GainSet]] = {}
        self._current: dict[int, int] = {}  # the number of the set in force
        self._expected: set[int] = set()  # axes of which gains have just been set here

    def expect(self, axis: int) -> None:
        """What is found next to be another set was set here."""
        self._expected.add(axis)

    def look(self, session: MillSession, axis: int, now_s: float) -> GainSet:
        """The set that is in force, read from the card; another one than before is added."""
        rows = self._rows(session, axis)
        is_expected = axis in self._expected
        self._expected.discard(axis)
        current = self._in_force(axis)
        if current is not None and rows == current.rows:
            return current
        by: By = "start" if current is None else "here" if is_expected else "elsewhere"
        filters = current.filters if current is not None else None
        if current is None or rows[len(tuned.GAINS) :] != current.rows[len(tuned.GAINS) :]:
            filters = session.card.perform(lambda talk: settings_of(talk, axis)).filters
        sets = self._sets.setdefault(axis, [])
        number = sets[-1].number + 1 if sets else 1
        before = self._current.get(axis, 0)
        return self._add(axis, GainSet(number, before, now_s, by, rows, filters), current)

    def set_again(
        self, session: MillSession, axis: int, number: int, now_s: float
    ) -> dict[str, float]:
        """Set gains and filters as an earlier or later set has them; those gains that change.

        UserError for a set that is not there, and for filters that no command can set.
        """
        current, wanted = self.look(session, axis, now_s), self._set(axis, number)
        changed = {
            word: value for word, value in wanted.gains.items() if value != current.gains[word]
        }
        lines = [f"AXIS{axis} {word} {number_text(value)}" for word, value in changed.items()]
        if wanted.rows[len(tuned.GAINS) :] != current.rows[len(tuned.GAINS) :]:
            if wanted.filters is None:
                raise UserError(
                    f"set {number}: its filters were written by hand, no command sets them again"
                )
            lines += wanted.filters.lines(axis)
        self.expect(axis)
        session.machine.type(lines)
        again = replace(wanted, rows=self._rows(session, axis))  # as the card rounds them
        sets = self._sets[axis]
        sets[sets.index(wanted)] = again
        self._current[axis] = number
        self._expected.discard(axis)
        return changed

    def require_kept(self, axis: int, number: int) -> None:
        """Refuse to keep a set whose filters the parameters of the machine cannot hold."""
        filters = self._set(axis, number).filters
        if filters is None or filters.is_filtering:
            raise UserError(
                f"set {number} has filters, and the parameters of the machine have no NOTCH and"
                " LOPASS: set it without keeping it"
            )

    def data(self, axis: int, now_s: float, name_of: Callable[[str], str]) -> dict[str, Any]:
        """The sets of an axis, first to last, each with what it changes of that before it."""
        sets = self._sets.get(axis, [])
        current = self._in_force(axis)
        gains = {} if current is None else current.gains
        return {
            "current": self._current.get(axis, 0),
            "gains": {name_of(word): _short(value) for word, value in gains.items()},
            "sets": [
                {
                    "number": each.number,
                    "before": each.before,
                    "age_s": round(now_s - each.at_s, 3),
                    "by": each.by,
                    "changed": [
                        [name_of(word), *map(_short, values)] for word, *values in each.changed
                    ],
                }
                for each in sets
            ],
        }

    def _rows(self, session: MillSession, axis: int) -> Rows:
        places = [*tuned.GAINS.values(), *(row for rows in FILTERS for row in rows)]
        return tuple(session.machine.read_rows([row[axis] for row in places]))

    def _in_force(self, axis: int) -> GainSet | None:
        number = self._current.get(axis)
        return None if number is None else self._set(axis, number)

    def _set(self, axis: int, number: int) -> GainSet:
        sets = self._sets.get(axis, [])
        found = next((each for each in sets if each.number == number), None)
        if found is None:
            known = f"{sets[0].number} to {sets[-1].number}" if sets else "none yet"
            raise UserError(f"set {number} of gains is not there (kept: {known})")
        return found

    def _add(self, axis: int, new: GainSet, current: GainSet | None) -> GainSet:
        """Add a set; a further change of the same gain takes the place of the last one."""
        sets = self._sets[axis]
        new = replace(new, changed=_changed(current, new))
        former = self._carried_on(axis, new, current)
        if current is not None and former is not None:
            sets.pop()
            new = replace(
                new,
                number=current.number,
                before=current.before,
                changed=_changed(former, new),
            )
        sets.append(new)
        self._current[axis] = new.number
        if len(sets) > MOST:
            del sets[1]
        return new

    def _carried_on(self, axis: int, new: GainSet, current: GainSet | None) -> GainSet | None:
        """The set before the last one where a new set only continues what that has changed."""
        sets = self._sets[axis]
        if current is None or current is not sets[-1]:
            return None
        words = [[word for word, *_ in each.changed] for each in (current, new)]
        is_later = new.at_s - current.at_s > SAME_S
        if current.by != new.by or is_later or words[0] != words[1]:
            return None
        return next((each for each in sets if each.number == current.before), None)


def _changed(before: GainSet | None, after: GainSet) -> tuple[Changed, ...]:
    """What a set changes of another: words with both values."""
    if before is None:
        return ()
    former = before.values
    return tuple(
        (word, former[word], value) for word, value in after.values.items() if value != former[word]
    )


def _short(value: float | str) -> float | str:
    """A value of a card with the digits that it has."""
    return value if isinstance(value, str) else float(f"{value:.{FP32_DIGITS}g}")


def _filter_texts(filters: Filters | None) -> dict[str, str]:
    if filters is None:
        return dict.fromkeys(FILTER_WORDS, "?")
    notch = f"{filters.notch_hz:g},{filters.notch_width_hz:g}"
    return dict(zip(FILTER_WORDS, (f"{filters.lopass_hz:g}", notch), strict=True))
