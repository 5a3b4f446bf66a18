"""The order of lines: jumps, calls and the levels of calls."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from enum import Enum, auto

from msgspec import Struct

from openacr.cnc.canonical import Source
from openacr.cnc.program.labels import Part, Place
from openacr.cnc.program.program import Node, Nodes, Program
from openacr.cnc.reading.findings import CodeError

DEEPEST = 10


class Level(Enum):
    """Why a level was entered."""

    SUB = auto()  # GOSUB
    MACRO = auto()  # G65
    MODAL_MACRO = auto()  # G66
    CUSTOM = auto()  # M code of the user
    CYCLE = auto()


class Frame(Struct, eq=False):
    """One call; a GOSUB returns to a line, the others to the calling function."""

    level: Level
    back: Node | None = None
    is_done: bool = False
    caller: Source | None = None  # the block of a cycle


class Flow:
    """The place in the program."""

    def __init__(self, program: Program) -> None:
        self._program = program
        self._nodes = Nodes(program)
        self.next: Node | None = None
        # How to find `next` when it is needed: after a line, or at a position.
        self.last: Node | None = None
        self.place: Place | None = None
        self.frames: list[Frame] = []
        self.jumped: Callable[[], None] | None = None  # sees every jump that may be a loop

    def start(self) -> None:
        """Go to the first line, outside of calls."""
        self.frames.clear()
        self.go_place(self._program.main.start)

    def leave(self) -> None:
        """Leave the program: no line comes next."""
        self.frames.clear()
        self.next = self.last = self.place = None

    def pass_by(self, node: Node) -> None:
        """Go to the line after this one; in a cycle it acts for the block that calls that."""
        if self.frames and self.frames[-1].caller is not node.source.caller:
            node.source = replace(node.source, caller=self.frames[-1].caller)
        self.next = node.next
        self.last = node if node.next is None else None
        self.place = None

    def following(self) -> Node | None:
        """The line that comes next; None at the end."""
        last = self.last
        if last is not None:
            self.next = last.next = self._nodes.next_after(last)
            self.last = None
        elif self.place is not None:
            self.next, self.place = self._nodes.at(self.place), None
        return self.next

    def next_after(self, node: Node) -> Node | None:
        """The line after another one."""
        if node.next is None:
            node.next = self._nodes.next_after(node)
        return node.next

    def ahead(self) -> Place | None:
        """The position of the next line in the same text; None where that is not known."""
        node = self.next
        if node is not None:
            return Place(node.part, node.offset, node.line) if node.offset >= 0 else None
        last = self.last
        if last is None:
            return self.place
        if last.is_include or last.part.continues_at is not None:
            return None
        return Place(last.part, last.after, last.line + 1)

    def go_place(self, place: Place) -> None:
        """Continue at a position."""
        self.next, self.last, self.place = None, None, place

    def at(self, place: Place) -> Node | None:
        """The line at a position."""
        return self._nodes.at(place)

    # --- jumps ------------------------------------------------------------------------

    def labelled(self, label: int, node: Node, column: int) -> Node:
        """The line with a label that another line jumps to."""
        found = self.find(label, node.part, column)
        if found.part.is_cycles and not node.part.is_cycles:
            raise CodeError("E264", column, f"N{label}")
        return found

    def find(self, label: int, part: Part, column: int = 0) -> Node:
        """The line with a label, in the texts that share their labels."""
        place = part.labels.get(label)
        node = self._nodes.at(place) if place else None
        if node is None:
            raise CodeError("E220", column, f"N{label}")
        return node

    def go(self, node: Node | None) -> None:
        """Continue at a line; None ends the program."""
        self.next, self.last, self.place = node, None, None

    def jump(self, node: Node) -> None:
        """Jump to a line (GOTO)."""
        if self.jumped is not None:
            self.jumped()
        self.go(node)

    def call_sub(self, node: Node) -> None:
        """Call a line (GOSUB)."""
        self.enter(Frame(Level.SUB, self.following()))
        self.go(node)

    def enter(self, frame: Frame) -> None:
        """Enter a call; E260 if nested too deep (cycles do not count)."""
        counted = [one for one in self.frames if one.level is not Level.CYCLE]
        if frame.level is not Level.CYCLE and len(counted) >= DEEPEST:
            raise CodeError("E260")
        self.frames.append(frame)

    def go_back(self, column: int) -> None:
        """Return from a call (RET)."""
        if not self.frames:
            raise CodeError("E261", column)
        frame = self.frames.pop()
        frame.is_done = True
        if frame.level is Level.SUB:
            self.go(frame.back)

    def is_within(self, level: Level) -> bool:
        """Whether a call of that kind is in force."""
        return any(frame.level is level for frame in self.frames)
