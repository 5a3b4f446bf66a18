"""G40, G41 and G42: the phases of a compensated contour."""

from collections.abc import Iterator
from enum import Enum, auto
from typing import Generic

from openacr.cnc.canonical import Moves, Point
from openacr.cnc.compensation.chain import Chain
from openacr.cnc.compensation.entry import entry_arc
from openacr.cnc.compensation.many import Watch
from openacr.cnc.compensation.moves import is_motion, moved
from openacr.cnc.compensation.pieces import Held
from openacr.cnc.compensation.rules import Report, Rules, Side
from openacr.cnc.geometry.elements import Element


class Phase(Enum):
    """The phase of the contour the program is in."""

    OFF = auto()
    LEADING_IN = auto()  # G41 or G42 was read, nothing has moved yet
    ON = auto()
    LEADING_OUT = auto()  # G40 was read, the tool is beside the last element


class Compensator(Generic[Held]):
    """Turns elements of the contour into those of the tool's centre, in program order.

    Every method returns what can be issued by now, in order. An element is issued when the
    next one is known; where elements may be left out (Gouge Stop off), five more wait.
    """

    def __init__(self, rules: Rules, report: Report, watch: Watch | None = None) -> None:
        self._report = report
        self._has_entry_arcs = rules.has_entry_arcs
        self._chain: Chain[Held] = Chain(rules, report, watch)
        self._phase = Phase.OFF
        self._side = Side.LEFT

    @property
    def is_on(self) -> bool:
        """Whether G41 or G42 is in force."""
        return self._phase in (Phase.LEADING_IN, Phase.ON)

    @property
    def is_following(self) -> bool:
        """Whether every move is an element of the contour."""
        return self._phase is Phase.ON

    @property
    def place(self) -> tuple[float, float] | None:
        """Where the tool rests in the plane; None where that is the programmed point."""
        return self._chain.at

    def switch(self, side: Side | None, radius: float = 0.0) -> list[Held | Element]:
        """Switch to G40 (no side), G41, G42, or to another radius for the next elements."""
        if side is None:
            self._switch_off()
        else:
            self._switch_on(side, radius)
        return self._chain.drain()

    def _switch_on(self, side: Side, radius: float) -> None:
        news = self._chain.news
        if radius < 0.0:
            news.append(("W310", f"negative radius {radius:g}: the tool is on the other side"))
        if self._phase is not Phase.ON:
            self._phase = Phase.LEADING_IN
        elif side is not self._side:
            news.append(("W313", f"{side.value} follows {self._side.value} without G40"))
        self._side = side
        self._chain.away = radius if side is Side.LEFT else -radius

    def _switch_off(self) -> None:
        if self._phase is Phase.ON:
            self._chain.finish()
            self._phase = Phase.LEADING_OUT
        elif self._phase is Phase.LEADING_IN:
            self._phase = Phase.OFF if self._chain.at is None else Phase.LEADING_OUT

    def add(self, element: Element) -> list[Held | Element]:
        """Add the next element of the program."""
        chain = self._chain
        if self._phase is Phase.ON:
            chain.follow(element)
        elif self._phase is Phase.OFF:
            return [element]
        elif not is_motion(element):
            chain.rest(element)
        elif self._phase is Phase.LEADING_IN:
            self._lead_in(element)
        else:
            self._lead_out(element)
        return chain.drain()

    def add_many(
        self, contour: Moves, start: Point, shift: Point
    ) -> Iterator[list[Held | Element]]:
        """Add the next elements, while `is_following`: the first begins at the point `start`.

        `shift` leads from program to machine coordinates. Yields what can be issued by then.
        """
        return self._chain.follow_many(contour, start, shift)

    def hold(self, thing: Held, *, is_after: bool = False) -> list[Held | Element]:
        """Hold an entry between two elements: it is issued where the first one ends.

        `is_after`: after the moves that are inserted at the corner.
        """
        self._chain.hold(thing, is_after)
        return self._chain.drain()

    def flush(self) -> list[Held | Element]:
        """Issue everything, because the next entry waits for rest."""
        self._chain.finish()
        return self._chain.drain()

    def stop(self) -> list[Held | Element]:
        """Issue everything and switch compensation off without a move (M2, ABORT)."""
        self._chain.finish()
        self._phase = Phase.OFF
        self._chain.forget()
        return self._chain.drain()

    def _lead_in(self, element: Element) -> None:
        chain = self._chain
        chain.report_pending(element)
        if element.centre is None:
            chain.begin(self._from_here(element))
        elif (contour := self._entry_arc(element)) is not None:
            chain.begin_with_arc(contour)
        else:
            chain.put(element)
            return
        self._phase = Phase.ON

    def _entry_arc(self, element: Element) -> Element | None:
        """The contour of an arc as lead-in; None, with a report, if it cannot be one."""
        if not self._has_entry_arcs:
            self._report("E313", "compensation cannot begin with an arc", element)
            return None
        plane, away = element.plane, self._chain.away
        here = self._chain.at or (element.start[plane.first], element.start[plane.second])
        contour = entry_arc(element, away, here)
        if contour is None:
            text = f"the tool, radius {abs(away):g}, cannot lead in along this arc"
            self._report("E313", text, element)
        return contour

    def _lead_out(self, element: Element) -> None:
        if element.centre is not None:
            self._report("E313", "compensation cannot end with an arc", element)
        self._chain.lead_out(self._from_here(element))
        self._phase = Phase.OFF
        self._chain.forget()

    def _from_here(self, element: Element) -> Element:
        """A straight move from where the tool is."""
        start, at = element.start, self._chain.at
        if at is not None:
            start = moved(start, element.plane, *at)
        return Element(
            element.source, element.plane, start, element.end, element.pace, is_compensated=True
        )
