"""What came out of lines that were executed together: entries of the arrays."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from msgspec.structs import replace

from openacr.cnc.canonical import Moves, Pace, Point, Polyline, Source
from openacr.cnc.canonical.batches import Origin
from openacr.cnc.program.block_context import BlockContext
from openacr.cnc.program.program import Node
from openacr.cnc.reading.text import decoded
from openacr.cnc.rows import moves, results
from openacr.cnc.rows.moves import CURVE, POINT, ROW
from openacr.cnc.rows.room import doubles, integers

if TYPE_CHECKING:
    from openacr.cnc.interpreter.by_block.inside import Inside
    from openacr.cnc.interpreter.by_line.fast_plans import Notes
    from openacr.cnc.program.labels import Part
    from openacr.views import F64, I32


class Scanned:
    """The rows of many lines of a text, and how they become entries."""

    def __init__(self, run: Inside, notes: Notes, nodes: dict[int, Node]) -> None:
        self._run = run
        self._notes = notes
        self._nodes = nodes  # of the cycles
        memory = run.memory
        self._ends, self._arcs = memory.reals(results.end_u), memory.reals(results.arc)
        self._rows, self._feeds = memory.wholes(results.row), memory.reals(results.feed_upm)

    def moves(self, count: int, paces: int, part: Part, data: memoryview, begin: Point) -> None:
        """Hand out moves of `paces` paces from a machine point on, with entries between them."""
        run, rows = self._run, integers(count * ROW)
        rows[:] = self._rows[: count * ROW]
        ends, arcs = doubles(count * POINT), doubles(count * CURVE)
        ends[:], arcs[:] = self._ends[: count * POINT], self._arcs[: count * CURVE]
        origins = self._origins(part, data)
        known = self._paces(paces)
        first = 0
        kinds = rows[moves.KIND :: ROW].tolist() if count else []
        notes = [k for k, kind in enumerate(kinds) if kind == moves.NOTE]
        for k in (*notes, count):
            if k > first:
                which = rows[first * ROW : k * ROW], ends[first * POINT : k * POINT]
                found = Moves(origins, *which, arcs[first * CURVE : k * CURVE], known)
                if run.path.elements is None:
                    run.out.append(found)
                    run.is_rested = False
                else:
                    run.offset_path.add_many(found, begin)
                begin = found.end_of(k - first - 1)
            if k < count:
                self._note(k, rows, ends, part, data)
            first = k + 1

    def _note(self, k: int, rows: I32, ends: F64, part: Part, data: memoryview) -> None:
        """Let a code act that tells something between two moves."""
        line, number, begin, end, text = (
            rows[ROW * k + at]
            for at in (moves.LINE_NUMBER, moves.PLANE, moves.START, moves.STOP, moves.TEXT)
        )
        plan, code = self._notes.codes[number]
        node = self._nodes[begin] if text else Node(part, line, line_text(data, begin, end), end)
        values = ends[POINT * k : POINT * (k + 1)]
        b = BlockContext(node, plan, dict(zip(plan.words, values, strict=False)))
        b.number = code.number
        code.act(self._run, b)

    def polyline(self, count: int, part: Part, data: memoryview) -> None:
        """Hand out straight feed moves of one pace."""
        import numpy as np

        R = self._rows
        ends = np.array(self._ends[: count * POINT]).reshape(count, POINT)
        lines = np.array(R[moves.LINE_NUMBER : count * ROW : ROW], np.int64)
        text = line_text(data, R[moves.START], R[moves.STOP])
        source = Source(part.text.name, int(lines[0]), text)
        self._run.out.append(Polyline(source, ends, lines, self._paces(1)[0]))
        self._run.is_rested = False

    def _paces(self, count: int) -> tuple[Pace, ...]:
        """The paces of the moves: they differ in the feed alone."""
        present = self._run.path.plain_pace()
        feeds = self._feeds[:count].tolist()
        known = {present.feed_upm: present}
        for feed in set(feeds) - known.keys():
            known[feed] = replace(present, feed_upm=feed)
        return tuple(known[feed] for feed in feeds)

    def _origins(self, part: Part, data: memoryview) -> tuple[Origin, ...]:
        """The texts of the moves: that of the program, then that of the cycles."""
        own = Origin(part.text.name, partial(line_text, data))
        if not self._nodes:
            return (own,)
        nodes = self._nodes
        name = next(iter(nodes.values())).part.text.name
        return own, Origin(name, lambda begin, _: nodes[begin].raw)


def line_text(data: memoryview, begin: int, end: int) -> str:
    """The text of a line, without its end."""
    return decoded(bytes(data[begin:end]).rstrip(b"\r\n"))
