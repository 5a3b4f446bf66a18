"""Cutter radius compensation in the interpreter: switching, adding moves, flushing.

Between G41 and the move after G40 every move goes through the compensator, and whatever
else the program says waits there for its place between two moves.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from openacr.cnc.canonical import BlockEnd, Entry, Moves, Point
from openacr.cnc.compensation import ChainCheck, Compensator, Rules, Side
from openacr.cnc.geometry.elements import Element
from openacr.cnc.program.block_context import BlockContext
from openacr.cnc.state.cells import EPSILON, RADIUS, RADIUS_WEAR
from openacr.sysvar.tabs import CONTROL

if TYPE_CHECKING:
    from openacr.cnc.interpreter.by_block.inside import Inside

OFF = 40
SIDES = {41: Side.LEFT, 42: Side.RIGHT}
_ARCS = (2, 3)


class OffsetPath:
    """The compensator of one program."""

    def __init__(self, run: Inside) -> None:
        self._run = run
        self._compensator = self._new()

    def _new(self) -> Compensator[Entry]:
        read = self._run.cells.read
        rules = Rules(
            read(EPSILON),
            read(CONTROL.sweep_epsilon),
            int(read(CONTROL.root_epsilon)),
            read(CONTROL.gouge_stop) != 0.0,
            self._run.dialect.has_entry_arcs,
        )
        watch = self._run.options.watch
        if watch is None and self._run.options.collects_errors:
            watch = ChainCheck(rules.epsilon, self._report)
        return Compensator(rules, self._report, watch)

    def begin(self) -> None:
        """A program starts: tolerances are read, nothing is on."""
        self._compensator = self._new()
        self._run.path.elements = None

    def _report(self, code: str, text: str, element: Element) -> None:
        self._run.complain(code, text, element.source)

    # --- switching ----------------------------------------------------------------------

    def switch(self, b: BlockContext, code: int) -> None:
        """G40, G41, G42."""
        run = self._run
        if code == OFF and run.modal.compensation == OFF:
            return
        begins = run.modal.compensation == OFF
        if self._is_arc(b) and not (begins and run.dialect.has_entry_arcs):
            raise b.fault("E313")
        run.modal.compensation = code
        run.path.change_pace()
        run.path.elements = self._add
        self._hand_on(self._compensator.switch(SIDES.get(code), self._radius()))
        self._look_whether_off()

    def refuse(self, b: BlockContext, code: str) -> None:
        """An error while compensation is on.

        After a G40 without a move, the program continues from where the tool is.
        """
        if self._run.modal.compensation != OFF:
            raise b.fault(code)
        self.stop()

    def _is_arc(self, b: BlockContext) -> bool:
        """Whether the block moves on an arc."""
        code = b.plan.motion_code
        motion = self._run.modal.motion if code is None else code
        return motion in _ARCS and b.plan.is_motion

    def _radius(self) -> float:
        return self._run.cells.read(RADIUS) + self._run.cells.read(RADIUS_WEAR)

    def change_radius(self) -> None:
        """D or a wear value has changed: it holds from the next element on."""
        side = SIDES.get(self._run.modal.compensation)
        if side is not None:
            self._run.path.change_pace()
            self._hand_on(self._compensator.switch(side, self._radius()))

    # --- moves and what stands between them -----------------------------------------------

    def _add(self, element: Element) -> None:
        self._hand_on(self._compensator.add(element))
        self._look_whether_off()

    @property
    def is_following(self) -> bool:
        """Whether every move is an element of a contour."""
        return self._compensator.is_following

    def add_many(self, contour: Moves, start: Point) -> None:
        """Add moves from a machine point on, while `is_following`."""
        shift = self._run.path.coordinates.shift
        for things in self._compensator.add_many(contour, start, shift):
            self._hand_on(things)

    def _look_whether_off(self) -> None:
        compensator = self._compensator
        if not compensator.is_on and compensator.place is None:
            self._run.path.elements = None

    def hold(self, entry: Entry) -> None:
        """Something without motion."""
        is_after = isinstance(entry, BlockEnd)
        self._hand_on(self._compensator.hold(entry, is_after=is_after))

    def flush(self) -> None:
        """Everything that waits is issued: the machine has to come to rest."""
        self._hand_on(self._compensator.flush())

    def stop(self) -> None:
        """The end of a program: off without a move; the machine stands where it is."""
        run = self._run
        if run.path.elements is None:
            return
        place = self._compensator.place
        self._hand_on(self._compensator.flush())
        place = self._compensator.place or place
        self._hand_on(self._compensator.stop())
        run.path.elements = None
        if place is not None:
            plane, target = run.modal.plane_axes, list(run.path.target)
            target[plane.first], target[plane.second] = place
            run.path.stand(tuple(target))

    def _hand_on(self, things: list[Entry | Element]) -> None:
        run = self._run
        for thing in things:
            if isinstance(thing, Element):
                run.path.issue(thing)
                continue
            run.out.append(thing)
            if isinstance(thing, Moves):
                run.path.issued = thing.end_of(len(thing) - 1)
                run.is_rested = False
