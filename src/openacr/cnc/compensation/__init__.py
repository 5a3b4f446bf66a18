"""Cutter radius compensation: from the programmed contour to the path of the tool's centre.

The interpreter passes the moves of the program to the compensator, in order; each call
returns what can be issued by then, elements and the entries held between them:

    compensator = Compensator(Rules(epsilon=0.002), report)
    out = compensator.switch(Side.LEFT, radius=0.25)     # G41, or another D while it is on
    out += compensator.add(element)                      # every G0 to G3, also while off
    out += compensator.hold(BlockEnd(source))            # an entry between two moves
    out += compensator.flush()                           # before a Sync
    out += compensator.switch(None)                      # G40
    out += compensator.add(element)                      # ... and the lead-out
    out += compensator.stop()                            # M2, end of text, ABORT

`report(code, text, element)` receives findings; the source of the element is the position.
Codes with E are errors: what is issued after one may be drawn, but not run.

Results are in the coordinates of the input, with `is_compensated`, and `is_inserted` for
the moves at corners, which carry the source of the block after the corner. Moves outside
the plane (a Z move, a rotary axis) are given to `add` like any other: they wait and are
issued where the tool then is. While `place` is not None the tool rests there in the plane
and not at the programmed point.

A `Watch` receives contours and tool paths. `ChainCheck` is one: it compares whole chains and
finds moves that come too near to any element.
"""

from openacr.cnc.compensation.compensator import Compensator
from openacr.cnc.compensation.listing import listing
from openacr.cnc.compensation.many import Watch
from openacr.cnc.compensation.rules import Report, Rules, Side
from openacr.cnc.compensation.whole import ChainCheck

__all__ = ["ChainCheck", "Compensator", "Report", "Rules", "Side", "Watch", "listing"]
