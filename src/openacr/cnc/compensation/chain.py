"""The elements between the way in and the way out, and the tool's way beside them."""

from math import hypot
from typing import Generic, TypeVar

from openacr.cnc.compensation.curve_cy import (
    AWAY,
    AX,
    AY,
    BX,
    BY,
    EMPTY,
    FITS,
    GOUGES,
    NOTHING,
    RADIUS,
    SHORTEST,
    T0X,
    T0Y,
    T1X,
    T1Y,
    UNEQUAL,
    X0,
    X1,
    Y0,
    Y1,
)
from openacr.cnc.compensation.gouge import largest_radius
from openacr.cnc.compensation.join_cy import APART, BRIDGE, CROSSING, FORCED, GAP, JOINED, ROUND
from openacr.cnc.compensation.moves import at_place, inserted, tool_way
from openacr.cnc.compensation.rows import Piece, Table, curve, distance, fit, join, place
from openacr.cnc.compensation.rules import Report, Rules, Watch
from openacr.cnc.elements import Element

Held = TypeVar("Held")

HELD_CNT = 100  # things that may wait for the end of an element
LEFT_OUT_CNT = 5  # elements in a row that may be left out


class Chain(Generic[Held]):
    """Pieces that are not issued yet, the last with an open end, and what was issued."""

    def __init__(self, rules: Rules, report: Report, watch: Watch | None) -> None:
        self.away = 0.0  # signed distance for the elements to come
        self.news: list[tuple[str, str]] = []  # findings about the next element
        self.ready: list[Held | Element] = []
        self.at: tuple[float, float] | None = None  # where the tool is, if not as programmed
        self._rules = rules
        self._root = rules.root
        self._report = report
        self._watch = watch
        self._table = Table()
        self._chain: list[Piece[Held]] = []
        self._last: Piece[Held] | None = None  # issued last
        self._is_inside = False  # something in front of the next element was left out

    def drain(self) -> list[Held | Element]:
        """What was issued since the last call."""
        ready = self.ready
        self.ready = []
        return ready

    def forget(self) -> None:
        """The chain has ended."""
        if self._watch:
            self._watch.end()
        self._last = None
        self.at = None
        self._is_inside = False
        self.news.clear()

    def tell(self, element: Element) -> None:
        """Report what was to be said about the next element."""
        for code, text in self.news:
            self._report(code, text, element)
        self.news.clear()

    def rest(self, thing: Held | Element) -> None:
        """Issue something where the tool is."""
        if self.at is not None and isinstance(thing, Element):
            thing = at_place(thing, self.at)
        self.ready.append(thing)

    def begin(self, element: Element) -> None:
        """The way in: a line from where the tool is to beside the start of the next element."""
        self._laid_out(element)
        F, row = self._table.F, self._table.row
        place(F, row, self.away)
        F[row + AX] = F[row + X0]
        F[row + AY] = F[row + Y0]
        length = hypot(F[row + X1] - F[row + X0], F[row + Y1] - F[row + Y0])
        if length < abs(self.away):
            self._report("W311", f"lead-in is shorter than the radius {abs(self.away):g}", element)
        self._chain = [Piece(element, self._table.keep(), is_lead_in=True)]

    def _laid_out(self, element: Element) -> int:
        """Fill the next row with an element."""
        start, end, plane = element.start, element.end, element.plane
        first, second = plane.first, plane.second
        cx, cy = element.centre or (0.0, 0.0)
        rules = self._rules
        return curve(
            self._table.F,
            self._table.row,
            start[first],
            start[second],
            end[first],
            end[second],
            cx,
            cy,
            element.sweep_rad,
            rules.epsilon,
            rules.sweep_epsilon,
        )

    def follow(self, element: Element) -> None:
        """The next element."""
        found = self._laid_out(element)
        if found == NOTHING:
            self.hold(element, False)
            return
        if self.news:
            self.tell(element)
        if self._watch:
            self._watch.contour(element)
        if found == UNEQUAL:
            self._report(
                "E315", f"start and end radius differ by more than {self._rules.epsilon:g}", element
            )
        if not place(self._table.F, self._table.row, self.away):
            self._leave_out_small(element)
            return
        self._connect(Piece(element, self._table.keep()))

    def _leave_out_small(self, element: Element) -> None:
        radius = self._table.F[self._table.row + RADIUS]
        text = f"arc of radius {radius:g} is not larger than the tool radius {abs(self.away):g}"
        if self._rules.gouge_stop:
            self._report("E320", text, element)
        else:
            self._report("W320", f"geometry adjusted: {text}, left out", element)
        self._is_inside = True

    def _connect(self, piece: Piece[Held]) -> None:
        chain = self._chain
        if not chain:
            self._restart(piece)
        else:
            last = chain[-1]
            self._meet(last, piece, self._is_inside)
            if last.fits == GOUGES or last.meets == APART:
                self._gouge(piece)
        self._is_inside = False
        chain.append(piece)
        limit = 1 if self._rules.gouge_stop else 1 + LEFT_OUT_CNT
        while len(chain) > limit:
            self._issue(chain.pop(0), chain[0])

    def _meet(self, last: Piece[Held], piece: Piece[Held], is_inside: bool) -> None:
        """Set the end of one piece and the start of the next."""
        F, i, j = self._table.F, last.row, piece.row
        rules = self._rules
        if last.is_lead_in:
            place(F, j, F[j + AWAY])
            F[i + BX], F[i + BY] = F[j + AX], F[j + AY]
            self._check_lead_in(last, piece)
            return
        last.meets = join(F, i, j, rules.epsilon, self._root, is_inside)
        last.fits = fit(F, i, rules.epsilon, rules.sweep_epsilon)

    def _check_lead_in(self, last: Piece[Held], piece: Piece[Held]) -> None:
        """Whether it begins on the material side of the element behind it."""
        F, i, j = self._table.F, last.row, piece.row
        x, y = F[i + X0], F[i + Y0]
        side = (x - F[j + X0]) * F[j + T0Y] - (y - F[j + Y0]) * F[j + T0X]
        nearest = distance(F, j, x, y)
        if F[j + AWAY] * side > 0.0 and nearest < abs(F[j + AWAY]):
            text = f"lead-in crosses the part: it begins {nearest:.6g} from line"
            self._report("W312", f"{text} {piece.element.source.line}", last.element)

    def _restart(self, piece: Piece[Held]) -> None:
        """Go on behind a chain that was broken: from where the tool rests to the new start."""
        last = self._last
        if last is None:
            return
        F, j, rules = self._table.F, piece.row, self._rules
        meets = join(F, last.row, j, rules.epsilon, self._root, False)
        if meets not in (JOINED, ROUND, BRIDGE):
            self._report("W324", "the chain is broken by a waiting block", piece.element)
            meets = BRIDGE
            place(F, j, F[j + AWAY])
        if self.at is not None:
            F[last.row + BX], F[last.row + BY] = self.at
        self._insert(last, piece, meets)

    # --- gouges -------------------------------------------------------------------------

    def _gouge(self, piece: Piece[Held] | None) -> None:
        """Report the last piece of the chain, or leave out what cannot be reached."""
        chain = self._chain
        bad = chain[-1]
        if self._rules.gouge_stop:
            self._refuse(bad, piece)
            return
        while bad.fits == GOUGES or bad.meets == APART:
            if len(chain) < 2 or chain[-2].left_out_cnt + bad.left_out_cnt >= LEFT_OUT_CNT:
                self._refuse(bad, piece)
                return
            self._report("W322", self._gouge_text(bad, piece) + ", left out", bad.element)
            before = chain[-2]
            self._take_out(before, chain.pop())
            if piece is None:
                self._end_beside(before)
            else:
                self._meet(before, piece, True)
            bad = before

    def _take_out(self, before: Piece[Held], bad: Piece[Held]) -> None:
        """What waited for the end of the bad piece waits for that of the one before it."""
        before.left_out_cnt += 1 + bad.left_out_cnt
        waiting = [*(before.held or ()), *(bad.held or ()), *(bad.held_behind or ())]
        before.held = waiting or None

    def _refuse(self, bad: Piece[Held], piece: Piece[Held] | None) -> None:
        if bad.meets == APART and piece is not None:
            text = f"no intersection with line {piece.element.source.line}"
            self._report("E321", f"{text} at radius {abs(self.away):g}", bad.element)
        if bad.fits == GOUGES:
            self._report("E322", self._gouge_text(bad, piece), bad.element)

    def _gouge_text(self, bad: Piece[Held], piece: Piece[Held] | None) -> str:
        chain = self._chain
        before = chain[-2] if len(chain) > 1 else self._last
        radius = largest_radius(self._table, before, bad, piece, self._rules)
        line, away = bad.element.source.line, abs(self._table.F[bad.row + AWAY])
        return (
            f"gouge: line {line} cannot be reached with radius {away:g} "
            f"(largest radius {radius:.6g})"
        )

    # --- issuing ------------------------------------------------------------------------

    def hold(self, thing: Held | Element, is_behind: bool) -> None:
        """Let something wait for the end of the last element."""
        if not self._chain:
            self.rest(thing)
            return
        last = self._chain[-1]
        held, behind = last.held or [], last.held_behind or []
        if len(held) + len(behind) >= HELD_CNT:
            self.finish()
            self.rest(thing)
            return
        (behind if is_behind else held).append(thing)
        last.held, last.held_behind = held, behind

    def _end_beside(self, piece: Piece[Held]) -> None:
        """Let a piece end beside the end of its element."""
        F, row, rules = self._table.F, piece.row, self._rules
        F[row + BX] = F[row + X1] - F[row + AWAY] * F[row + T1Y]
        F[row + BY] = F[row + Y1] + F[row + AWAY] * F[row + T1X]
        piece.meets = JOINED
        if not piece.is_lead_in:
            piece.fits = fit(F, row, rules.epsilon, rules.sweep_epsilon)

    def finish(self) -> None:
        """Issue the whole chain; the tool rests beside the end of its last element."""
        chain = self._chain
        if not chain:
            return
        self._end_beside(chain[-1])
        if chain[-1].fits == GOUGES:
            self._gouge(None)
        while chain:
            piece = chain.pop(0)
            self._issue(piece, chain[0] if chain else None)
        F, last = self._table.F, self._last
        if last is not None:
            self.at = (F[last.row + BX], F[last.row + BY])

    def _issue(self, piece: Piece[Held], following: Piece[Held] | None) -> None:
        F, row = self._table.F, piece.row
        if piece.is_lead_in:
            length = hypot(F[row + BX] - F[row + AX], F[row + BY] - F[row + AY])
            piece.fits = EMPTY if length < SHORTEST else FITS
        way = tool_way(F, piece)
        if way is not None:
            self.issue_way(way, abs(F[row + AWAY]))
        self._last = piece
        self.at = (F[row + BX], F[row + BY])
        if piece.held:
            for thing in piece.held:
                self.rest(thing)
        if following is not None and piece.meets > CROSSING:
            self._insert(piece, following, piece.meets)
        if piece.held_behind:
            if following is not None:
                self.at = (F[following.row + AX], F[following.row + AY])
            for thing in piece.held_behind:
                self.rest(thing)

    def _insert(self, piece: Piece[Held], following: Piece[Held], meets: int) -> None:
        F = self._table.F
        if meets == GAP or meets == FORCED:
            lines = f"lines {piece.element.source.line} and {following.element.source.line}"
            text = f"geometry adjusted: the ways beside {lines} do not cross"
            self._report("W320", text, following.element)
        for element in inserted(F, piece, following, meets):
            self.issue_way(element, abs(F[following.row + AWAY]))

    def issue_way(self, element: Element, radius: float) -> None:
        """Issue a move of the tool."""
        self.ready.append(element)
        if self._watch:
            self._watch.way(element, radius)
