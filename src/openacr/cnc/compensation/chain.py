"""The elements between lead-in and lead-out, and the tool path beside them."""

from typing import Generic, TypeVar

from openacr.cnc.canonical import Plane
from openacr.cnc.compensation.curve_cy import (
    AWAY,
    AX,
    AY,
    BX,
    BY,
    GOUGES,
    NOTHING,
    SMALL,
    T1X,
    T1Y,
    UNEQUAL,
    X1,
    Y1,
)
from openacr.cnc.compensation.gouge import gouge_text, report_apart, report_small
from openacr.cnc.compensation.join_cy import (
    APART,
    BRIDGE,
    CROSSING,
    FIT_STEP,
    FORCED,
    GAP,
    JOINED,
    ROUND,
)
from openacr.cnc.compensation.lead import begin_lead_in, end_lead_in
from openacr.cnc.compensation.moves import at_place, inserted, tool_move
from openacr.cnc.compensation.rows import Piece, Table, fit, lay, meet, place
from openacr.cnc.compensation.rules import Report, Rules, Watch
from openacr.cnc.geometry.elements import Element

Held = TypeVar("Held")

HELD_CNT = 100  # most entries that wait for the end of an element
LEFT_OUT_CNT = 5  # most consecutive elements that may be left out


class Chain(Generic[Held]):
    """The pieces that are not issued yet, the last one without an end."""

    def __init__(self, rules: Rules, report: Report, watch: Watch | None) -> None:
        self.away = 0.0  # signed distance for the elements to come
        self.news: list[tuple[str, str]] = []  # findings to report with the next element
        self.ready: list[Held | Element] = []
        self.at: tuple[float, float] | None = (
            None  # where the tool is, if not at the programmed point
        )
        self._rules = rules
        self._tolerances = (rules.epsilon, rules.sweep_epsilon)
        self._root = rules.root
        self._waiting_cnt = 1 if rules.gouge_stop else 1 + LEFT_OUT_CNT
        self._report = report
        self._watch = watch
        self._table = Table()
        self._plane = Plane.XY
        self._axes = (0, 1)
        self._chain: list[Piece[Held]] = []
        self._last: Piece[Held] | None = None  # issued last
        self._is_inside = False  # an element before the next one was left out

    def drain(self) -> list[Held | Element]:
        """Return what was issued since the last call."""
        ready = self.ready
        self.ready = []
        return ready

    def forget(self) -> None:
        """Clear the chain at its end."""
        if self._watch:
            self._watch.end()
        self._last = None
        self.at = None
        self._is_inside = False
        self.news.clear()

    def report_pending(self, element: Element) -> None:
        """Report the pending findings at the next element."""
        for code, text in self.news:
            self._report(code, text, element)
        self.news.clear()

    def rest(self, thing: Held | Element) -> None:
        """Issue an entry where the tool is."""
        if self.at is None or not isinstance(thing, Element):
            self.ready.append(thing)
        elif (element := at_place(thing, self.at)) is not None:
            self.ready.append(element)

    def begin(self, element: Element) -> None:
        """Begin with a lead-in: a line from the tool to beside the start of the next element."""
        self._laid_out(element)
        lead = Piece[Held](element, self._table.keep(), is_lead_in=True)
        begin_lead_in(self._table.F, lead)
        self._chain = [lead]

    def begin_with_arc(self, contour: Element) -> None:
        """Begin with a lead-in along an arc: the tool is beside its start."""
        self._laid_out(contour)
        if self._watch:
            self._watch.contour(contour)
        self._chain = [Piece[Held](contour, self._table.keep())]

    def _laid_out(self, element: Element) -> int:
        """Fill the next row with an element."""
        start, end, plane = element.start, element.end, element.plane
        if plane is not self._plane:
            self._plane = plane
            self._axes = (plane.first, plane.second)
        first, second = self._axes
        cx, cy = element.centre or (0.0, 0.0)
        return lay(
            self._table.F,
            self._table.row,
            start[first],
            start[second],
            end[first],
            end[second],
            cx,
            cy,
            element.sweep_rad,
            self.away,
            *self._tolerances,
        )

    def follow(self, element: Element) -> None:
        """Add the next element."""
        found = self._laid_out(element)
        if found == NOTHING:
            self.hold(element, False)
            return
        if self.news:
            self.report_pending(element)
        if self._watch:
            self._watch.contour(element)
        if found & UNEQUAL:
            limit = self._rules.epsilon
            self._report("E315", f"start and end radius differ by more than {limit:g}", element)
        if found & SMALL:
            report_small(self._report, Piece(element, self._table.row), self._table, self._rules)
            self._is_inside = True
        else:
            self._connect(Piece(element, self._table.keep()))

    def _connect(self, piece: Piece[Held]) -> None:
        chain = self._chain
        if chain:
            last = chain[-1]
            self._meet(last, piece, self._is_inside)
            if last.fits == GOUGES or last.meets == APART:
                self._gouge(piece)
        else:
            self._restart(piece)
        self._is_inside = False
        chain.append(piece)
        while len(chain) > self._waiting_cnt:
            self._issue(chain.pop(0), chain[0])

    def _meet(self, last: Piece[Held], piece: Piece[Held], is_inside: bool) -> None:
        """Set the end of one piece and the start of the next."""
        F, i, j = self._table.F, last.row, piece.row
        if last.is_lead_in:
            end_lead_in(F, last, piece, self._report, self._rules.epsilon)
            return
        found = meet(F, i, j, *self._tolerances, self._root, is_inside)
        last.fits, last.meets = divmod(found, FIT_STEP)

    def _restart(self, piece: Piece[Held]) -> None:
        """Continue after a broken chain: from where the tool rests to the new start."""
        last = self._last
        if last is None or self.at is None:
            return
        F, j = self._table.F, piece.row
        meets = meet(F, last.row, j, *self._tolerances, self._root, False) % FIT_STEP
        if meets == JOINED and (F[j + AX], F[j + AY]) == self.at:
            return
        if meets not in (ROUND, BRIDGE):
            self._report("W324", "the chain is broken by a waiting block", piece.element)
            meets = BRIDGE
            place(F, j, F[j + AWAY])
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
            self._report("W322", f"{self._gouge_text(bad, piece)}, left out", bad.element)
            before = chain[-2]
            self._take_out(before, chain.pop())
            if piece is None:
                self._end_beside(before)
            else:
                self._meet(before, piece, True)
            bad = before

    def _take_out(self, before: Piece[Held], bad: Piece[Held]) -> None:
        """Remove a piece; what waited for its end now waits for that of the one before it."""
        before.left_out_cnt += 1 + bad.left_out_cnt
        waiting = [*(before.held or ()), *(bad.held or ()), *(bad.held_after or ())]
        before.held = waiting or None

    def _refuse(self, bad: Piece[Held], piece: Piece[Held] | None) -> None:
        if bad.meets == APART and piece is not None:
            report_apart(self._report, bad, piece, self._table)
        if bad.fits == GOUGES:
            self._report("E322", self._gouge_text(bad, piece), bad.element)

    def _gouge_text(self, bad: Piece[Held], piece: Piece[Held] | None) -> str:
        before = self._chain[-2] if len(self._chain) > 1 else self._last
        return gouge_text(self._table, before, bad, piece, self._rules)

    # --- issuing ------------------------------------------------------------------------

    def hold(self, thing: Held | Element, is_after: bool) -> None:
        """Hold an entry until the end of the last element."""
        if not self._chain:
            self.rest(thing)
            return
        last = self._chain[-1]
        held, after = last.held or [], last.held_after or []
        if len(held) + len(after) >= HELD_CNT:
            self.finish()
            self.rest(thing)
            return
        (after if is_after else held).append(thing)
        last.held, last.held_after = held, after

    def _end_beside(self, piece: Piece[Held]) -> None:
        """Let a piece end beside the end of its element."""
        F, row = self._table.F, piece.row
        F[row + BX] = F[row + X1] - F[row + AWAY] * F[row + T1Y]
        F[row + BY] = F[row + Y1] + F[row + AWAY] * F[row + T1X]
        piece.meets = JOINED
        if not piece.is_lead_in:
            piece.fits = fit(F, row, *self._tolerances)

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

    def _issue(self, piece: Piece[Held], following: Piece[Held] | None) -> None:
        move = tool_move(self._table.F, piece)
        if move is not None:
            self.issue_tool_move(move, self._table.F[piece.row + AWAY])
        self._last = piece
        if piece.held or following is None:
            self._rest_at(piece.row + BX, piece.held)
        if following is not None and piece.meets > CROSSING:
            self._insert(piece, following, piece.meets)
        if piece.held_after:
            self._rest_at((following or piece).row + (AX if following else BX), piece.held_after)

    def _rest_at(self, place: int, things: list[Held | Element] | None) -> None:
        """Issue things where the tool rests; its coordinates are in the table."""
        self.at = (self._table.F[place], self._table.F[place + 1])
        for thing in things or ():
            self.rest(thing)

    def _insert(self, piece: Piece[Held], following: Piece[Held], meets: int) -> None:
        F = self._table.F
        if meets == GAP or meets == FORCED:
            lines = f"lines {piece.element.source.line} and {following.element.source.line}"
            text = f"geometry adjusted: the paths beside {lines} do not cross"
            self._report("W320", text, following.element)
        for element in inserted(F, piece, following, meets):
            self.issue_tool_move(element, F[following.row + AWAY])

    def issue_tool_move(self, element: Element, away: float) -> None:
        """Issue a move of the tool."""
        self.ready.append(element)
        if self._watch:
            self._watch.centre_path(element, abs(away))
