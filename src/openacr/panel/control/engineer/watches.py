"""Parameters and flag words that browsers watch: read together, reported when they change."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import NamedTuple

from openacr.client.errors import RefusedError
from openacr.client.names import parameter_number
from openacr.errors import CardError, UserError
from openacr.map import numbers as n
from openacr.panel.control.machine.place import Rows

MOST = 256  # of one client
INPUTS = (n.W_INPUTS, n.W_INPUTS + 1)  # inputs and outputs of the card


class Wish(NamedTuple):
    """A client and the topic it has subscribed."""

    client: int
    topic: str


Changed = list[tuple[int, float]]  # place in the list of the client, value
Report = Callable[[Wish, list[int], Changed], None]


@dataclass(slots=True)
class _Watch:
    parameters: list[int]
    every_s: float
    report: Report | None = None  # None: that of the browsers
    due_s: float = 0.0
    reported: dict[int, float] = field(default_factory=dict)  # by place


class Watches:
    """What all browsers watch on one card."""

    def __init__(self) -> None:
        self._watches: dict[Wish, _Watch] = {}
        self._undefined: set[int] = set()  # variables the card does not have
        self.report: Report = lambda _wish, _parameters, _changed: None

    def begin(
        self, wish: Wish, parameters: list[int], hz: float, report: Report | None = None
    ) -> None:
        """Watch parameters from now on; the first look tells all of them, to `report` if given."""
        self._watches[wish] = _Watch(parameters, 1.0 / hz, report)
        self._undefined.clear()  # they may have been dimensioned since

    def end(self, wish: Wish) -> None:
        """End a subscription."""
        self._watches.pop(wish, None)

    def forget(self, client: int) -> None:
        """End everything a client watches."""
        self._watches = {w: each for w, each in self._watches.items() if w.client != client}

    def renew(self) -> None:
        """Tell all values again: the card is at another moment."""
        for each in self._watches.values():
            each.reported, each.due_s = {}, 0.0
        self._undefined.clear()

    def look(self, read: Rows, now_s: float, *, is_past: bool = False) -> None:
        """Read what is due, all of it with one request, and tell what has changed.

        A moment of the past is for browsers alone.
        """
        due = {
            wish: each
            for wish, each in self._watches.items()
            if now_s >= each.due_s - 0.005 and not (is_past and each.report)
        }
        wanted = list(dict.fromkeys(p for each in due.values() for p in each.parameters))
        if not wanted:
            return
        values = self._known(read, wanted)
        for wish, each in due.items():
            each.due_s = max(each.due_s + each.every_s, now_s)
            now = {place: values[p] for place, p in enumerate(each.parameters) if p in values}
            changed = [(place, v) for place, v in now.items() if each.reported.get(place) != v]
            if changed:
                each.reported = now
                (each.report or self.report)(wish, each.parameters, changed)

    def _known(self, read: Rows, wanted: list[int]) -> dict[int, float]:
        """The values of parameters; variables that the card does not have are left out."""
        known = [p for p in wanted if p not in self._undefined]
        try:
            return dict(zip(known, read(known), strict=True)) if known else {}
        except (RefusedError, CardError):  # of the whole request: which one is it?
            values = {}
            for parameter in known:
                try:
                    values[parameter] = read([parameter])[0]
                except (RefusedError, CardError):
                    self._undefined.add(parameter)
            return values


def watched(whats: Iterable[object]) -> list[int]:
    """The numbers of parameters that are named or numbered; UserError for unknown ones."""
    found = []
    for what in whats:
        if isinstance(what, bool) or not isinstance(what, int | str):
            raise UserError(f"{what!r} is neither a number nor a name of a parameter")
        found.append(parameter_number(what))
    if len(found) > MOST:
        raise UserError(f"{len(found)} parameters: {MOST} at most can be watched at once")
    return found
