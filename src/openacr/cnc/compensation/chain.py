"""The elements between lead-in and lead-out, and the tool path beside them.

The loop is `chain_follow`; here is what is to be done where it ends: findings, gouges, entries
that wait, the begin and the end of a chain.
"""

from array import array
from collections.abc import Iterator

from openacr.cnc.canonical import AXES, Moves, Point
from openacr.cnc.compensation import chain_cy as core
from openacr.cnc.compensation.curve_cy import (
    AWAY,
    AX,
    AY,
    BX,
    BY,
    GOUGES,
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
    FORCED,
    GAP,
    JOINED,
    ROUND,
)
from openacr.cnc.compensation.lead import begin_lead_in, end_lead_in
from openacr.cnc.compensation.many import Many, Watch
from openacr.cnc.compensation.moves import at_place
from openacr.cnc.compensation.pieces import Held, Pieces
from openacr.cnc.compensation.rows import Piece, Table, fit, place
from openacr.cnc.compensation.rules import Report, Rules
from openacr.cnc.geometry.elements import Element
from openacr.cnc.rows import chains
from openacr.compiled import pick

HELD_CNT = 100  # most entries that wait for the end of an element
LEFT_OUT_CNT = 5  # most consecutive elements that may be left out
_follow = pick(core.chain_follow)
_connect = pick(core.chain_connect)
_push = pick(core.chain_push)
_meet = pick(core.chain_meet)
_drop = pick(core.chain_drop)
_move = pick(core.chain_move)
_between = pick(core.chain_between)


class Chain(Pieces[Held]):
    """The pieces that are not issued yet, the last one without an end."""

    def __init__(self, rules: Rules, report: Report, watch: Watch | None) -> None:
        super().__init__(Table(rules, 1 if rules.gouge_stop else 1 + LEFT_OUT_CNT), watch)
        self._rules = rules
        self._tolerances = (rules.epsilon, rules.sweep_epsilon)
        self._report = report
        self.at: tuple[float, float] | None = (
            None  # where the tool is, if not at the programmed point
        )

    def forget(self) -> None:
        """Clear the chain at its end."""
        if self._watch:
            self._collect()
            self._watch.end()
        self._I[chains.last_slot] = -1
        self.at = None
        self._I[chains.is_inside] = 0
        self.news.clear()

    def report_pending(self, element: Element) -> None:
        """Report the pending findings at the next element."""
        for code, text in self.news:
            self._report(code, text, element)
        self.news.clear()

    def rest(self, thing: Held | Element) -> None:
        """Issue an entry where the tool is."""
        if self.at is None or not isinstance(thing, Element):
            self.put(thing)
        elif (element := at_place(thing, self.at)) is not None:
            self.put(element)

    # --- elements -----------------------------------------------------------------------

    def begin(self, element: Element) -> None:
        """Begin with a lead-in: a line from the tool to beside the start of the next element."""
        lead = self._laid_out(element)
        lead.is_lead_in = True
        begin_lead_in(self._F, lead)
        _push(self._F, self._I)

    def begin_with_arc(self, contour: Element) -> None:
        """Begin with a lead-in along an arc: the tool is beside its start."""
        self._laid_out(contour)
        if self._watch:
            self._watch.contour(contour)
        _push(self._F, self._I)

    def follow(self, element: Element) -> None:
        """Add the next element."""
        self._take(element)
        status = _follow(self._F, self._I, self._row, self._end, self._arc, 0, 1)
        if self._watch and status != core.STILL:
            self._watch.contour(element)
        if status != core.DONE:
            self._attend(status)

    def follow_many(
        self, contour: Moves, start: Point, shift: Point
    ) -> Iterator[list[Held | Element]]:
        """Add elements from a point of the machine on; `shift` leads from program to machine.

        Yields what is issued, before each finding.
        """
        F, I = self._F, self._I
        many = self._many = Many(contour, start, self._known())
        self._table.at[:] = array("d", start)
        self._table.shift[:] = array("d", shift)
        F[chains.away_u], I[chains.tag] = self.away, 0
        k, count = 0, len(contour)
        while k < count:
            I[chains.has_news] = bool(self.news)
            status = _follow(F, I, contour.rows, contour.ends, contour.arcs, k, count)
            yield self.drain()
            if status == core.DONE:
                break
            k = I[chains.element]
            if status == core.FULL:
                continue
            if status == core.STILL:
                many.still.add(k)
            self._attend(status)
            k += 1
        yield self.drain()
        if self._watch:
            self._watch.elements(many)
        for piece in self._known():
            piece.number(0, piece.slot, 0)
        self._table.shift[:] = array("d", (0.0,) * AXES)
        self._many = None

    def _attend(self, status: int) -> None:
        """Do what the element in work needs before the loop can go on."""
        if status == core.HOLDS:
            self._release()
            return
        piece = self._piece(self._I[chains.next_slot])
        if status == core.STILL:
            self.hold(piece.element, False)
            return
        if status == core.FOUND:
            status = self._found(piece)
        if status in (core.BROKEN, core.LEADS, core.GOUGED):
            self._join(status, piece)
            status = _push(self._F, self._I)
        if status == core.HOLDS:
            self._release()

    def _found(self, piece: Piece[Held]) -> int:
        """Report what is wrong with an element, and connect it if the tool fits into it."""
        found, element = self._I[chains.found], piece.element
        if self.news:
            self.report_pending(element)
        if found & UNEQUAL:
            limit = self._rules.epsilon
            self._report("E315", f"start and end radius differ by more than {limit:g}", element)
        if found & SMALL:
            report_small(self._report, piece, self._table, self._rules)
            self._I[chains.is_inside] = 1
            return core.DONE
        return _connect(self._F, self._I)

    def _join(self, status: int, piece: Piece[Held]) -> None:
        """Join a piece to the one before where that is not ordinary."""
        if status == core.BROKEN:
            self._restart(piece)
        elif status == core.LEADS:
            end_lead_in(self._F, self._chain[-1], piece, self._report, self._rules.epsilon)
        else:
            self._gouge(piece)

    def _meet(self, last: Piece[Held], piece: Piece[Held], is_inside: bool) -> None:
        """Set the end of one piece and the start of the next."""
        if last.is_lead_in:
            end_lead_in(self._F, last, piece, self._report, self._rules.epsilon)
        else:
            _meet(self._F, self._I, last.slot, piece.slot, is_inside)

    def _restart(self, piece: Piece[Held]) -> None:
        """Continue after a broken chain: from where the tool rests to the new start."""
        last = self._last
        if last is None or self.at is None:
            return
        F, j, fits = self._F, piece.row, last.fits
        _meet(F, self._I, last.slot, piece.slot, False)
        last.fits = fits
        if last.meets == JOINED and (F[j + AX], F[j + AY]) == self.at:
            return
        if last.meets not in (ROUND, BRIDGE):
            self._report("W324", "the chain is broken by a waiting block", piece.element)
            last.meets = BRIDGE
            place(F, j, F[j + AWAY])
        F[last.row + BX], F[last.row + BY] = self.at
        self._insert(last, piece)

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
        self._I[chains.piece_cnt] -= 1
        before.left_out_cnt += 1 + bad.left_out_cnt
        waiting = [*(before.held or ()), *(bad.held or ()), *(bad.held_after or ())]
        before.held = waiting or None
        before.note_held()

    def _refuse(self, bad: Piece[Held], piece: Piece[Held] | None) -> None:
        if bad.meets == APART and piece is not None:
            report_apart(self._report, bad, piece, self._table)
        if bad.fits == GOUGES:
            self._report("E322", self._gouge_text(bad, piece), bad.element)

    def _gouge_text(self, bad: Piece[Held], piece: Piece[Held] | None) -> str:
        chain = self._chain
        before = chain[-2] if len(chain) > 1 else self._last
        return gouge_text(self._table, before, bad, piece, self._rules)

    # --- issuing ------------------------------------------------------------------------

    def hold(self, thing: Held | Element, is_after: bool) -> None:
        """Hold an entry until the end of the last element."""
        chain = self._table.chain
        if not chain:
            self.rest(thing)
            return
        last = self._piece(chain[-1])
        held, after = last.held or [], last.held_after or []
        if len(held) + len(after) >= HELD_CNT:
            self.finish()
            self.rest(thing)
            return
        (after if is_after else held).append(thing)
        last.held, last.held_after = held, after
        last.note_held()

    def _end_beside(self, piece: Piece[Held]) -> None:
        """Let a piece end beside the end of its element."""
        F, row = self._F, piece.row
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
        self._release(0)

    def _release(self, waiting_cnt: int | None = None) -> None:
        """Issue pieces until only those wait that have to; `waiting_cnt`: or this count."""
        most = self._I[chains.most_waiting] if waiting_cnt is None else waiting_cnt
        chain = self._chain
        while len(chain) > most:
            piece = chain.pop(0)
            _drop(self._I)
            self._issue(piece, chain[0] if chain else None)

    def _issue(self, piece: Piece[Held], following: Piece[Held] | None) -> None:
        _move(self._F, self._I, piece.slot)
        if piece.held or following is None:
            self._rest_at(piece.row + BX, piece.held)
        if following is not None and piece.meets > CROSSING:
            self._insert(piece, following)
        if piece.held_after:
            self._rest_at((following or piece).row + (AX if following else BX), piece.held_after)

    def _rest_at(self, place: int, things: list[Held | Element] | None) -> None:
        """Issue things where the tool rests; its coordinates are in the table."""
        self.at = (self._F[place], self._F[place + 1])
        for thing in things or ():
            self.rest(thing)

    def _insert(self, piece: Piece[Held], following: Piece[Held]) -> None:
        if piece.meets == GAP or piece.meets == FORCED:
            lines = f"lines {piece.element.source.line} and {following.element.source.line}"
            text = f"geometry adjusted: the paths beside {lines} do not cross"
            self._report("W320", text, following.element)
        _between(self._F, self._I, piece.slot, following.slot)

    def lead_out(self, element: Element) -> None:
        """Issue the move after the end of the contour."""
        self.put(element)
        if self._watch:
            self._watch.centre_path(element, abs(self.away))
