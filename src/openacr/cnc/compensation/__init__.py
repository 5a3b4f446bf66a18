"""Cutter radius compensation: from the programmed contour to the way of the tool's centre.

The interpreter tells the compensator what the program says, in order; each call returns
what can be issued by then, elements and the things that were held between them:

    compensator = Compensator(Rules(epsilon=0.002), report)
    out = compensator.switch(Side.LEFT, radius=0.25)     # G41, or another D while it is on
    out += compensator.add(element)                      # every G0 to G3, also while off
    out += compensator.hold(BlockEnd(source))            # what has its place between moves
    out += compensator.flush()                           # before a Sync
    out += compensator.switch(None)                      # G40
    out += compensator.add(element)                      # ... and the way out
    out += compensator.stop()                            # M2, end of text, ABORT

`report(code, text, element)` takes what is found; the source of the element is the place.
Codes with E are errors: what is issued behind one is for looking at, not for running.

Results are in the coordinates of what came in, with `is_compensated`, and `is_inserted` for
the moves at corners, which carry the source of the block behind the corner. Moves outside
the plane (a Z move, a rotary axis) may be given to `add` like any other: they wait and come
out where the tool then stands. While `place` is not None the tool rests there in the plane
and not at the programmed point.

A `Watch` sees contours beside their ways. `ChainCheck` is one: it compares whole chains and
finds moves that come too near to any element.
"""

from openacr.cnc.compensation.compensator import Compensator
from openacr.cnc.compensation.listing import listing
from openacr.cnc.compensation.rules import Report, Rules, Side, Watch
from openacr.cnc.compensation.whole import ChainCheck

__all__ = ["ChainCheck", "Compensator", "Report", "Rules", "Side", "Watch", "listing"]
