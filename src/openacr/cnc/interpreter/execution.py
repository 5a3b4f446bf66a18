"""Execution of blocks: each line is checked as a whole before it acts.

Where a value depends on the machine, reading it raises `NotAtRestError`: a `Sync` is handed
out, and the block is evaluated again when the machine is at rest.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from openacr.cnc.canonical import Entry, Say, Source
from openacr.cnc.codes.table import Code
from openacr.cnc.interpreter.by_block.inside import Inside, Quick, Ready
from openacr.cnc.interpreter.by_block.ready import ready, values_of
from openacr.cnc.interpreter.by_block.statements import shown
from openacr.cnc.interpreter.by_line.scanning import Scanner
from openacr.cnc.program.block_context import BlockContext
from openacr.cnc.program.flow import Frame, Level
from openacr.cnc.program.program import Node
from openacr.cnc.reading.blocks import Message
from openacr.cnc.reading.findings import BlockError, CodeError
from openacr.cnc.rows.runs import MOST_IDLE
from openacr.cnc.state.parameters import NotAtRestError

MACRO = "MACRO"
UNKNOWN = "######"  # a name without a value, in a text
_PARAMETER = re.compile(r"([#Pp])(?:(\d{1,7})|<([^<>]*)>)")
_ARITHMETIC = (ArithmeticError, ValueError)
_REASONS = {
    ZeroDivisionError: "division by zero",
    OverflowError: "too large a number",
    ValueError: "a function has no value there",
}


class Execution:
    """Runs the blocks of one interpreter."""

    def __init__(self, run: Inside) -> None:
        self._run = run
        self._flow = run.flow
        self.scanner = Scanner(run)
        self.node: Node | None = None  # the line that acts
        self.idle_cnt = 0
        self.until = 0  # the line a replay ends at
        self.is_arrived = False

    def blocks(self, frame: Frame | None = None) -> Iterator[Entry]:
        """Run block after block until the frame is left or the program has ended."""
        run, out = self._run, self._run.out
        has_block_ends = run.options.has_block_ends and not (frame and frame.level is Level.CYCLE)
        is_quick = not (run.options.has_block_ends or self.until)
        attend = run.options.attend if has_block_ends else None
        while not run.is_ended and (frame is None or not frame.is_done):
            try:
                while attend is None and self._scan():
                    yield from out
                    out.clear()
            except BlockError:  # of compensation
                yield from out
                out.clear()
                raise
            if is_quick and not self._race(frame):
                continue
            node = self._fetch()
            if node is None:
                return
            block = node.ready
            if block is None:  # the end of the text
                yield from run.flush()
                return
            if attend is not None:
                attend(node)
            if block.quick is not None:
                if not self._is_done(node, block.quick):
                    yield from run.sync(node.source)
                    self._is_done(node, block.quick)
            elif block.is_plain and (b := self._context(node, block)) is not None:
                waiting = self._act(b, block.acts)
                if waiting is not None:
                    yield from waiting
            else:
                yield from self.execute(node, block)
            if has_block_ends:
                run.end_block(node.source)
            if out:
                yield from out
                out.clear()

    def single(self, node: Node) -> Iterator[Entry]:
        """One block, and what it calls."""
        run = self._run
        self.node = node
        self.idle_cnt = 0
        block = ready(node, run)
        if not block.is_empty:
            yield from self.execute(node, block)
            yield from run.flush()
        if run.flow.frames and not run.is_ended:
            yield from self.blocks(run.flow.frames[0])
        run.offset_path.flush()
        yield from run.flush()

    def call(self, frame: Frame, start: Node, values: list[float]) -> Iterator[Entry]:
        """Run lines until RET leaves the frame; `values` are its locals."""
        run, flow = self._run, self._flow
        flow.enter(frame)
        back, here = flow.following(), self.node
        kept = run.parameters.swap([1.0, *values[1:]])
        flow.go(start)
        yield from run.flush()
        yield from self.blocks(frame)
        run.parameters.swap(kept)
        if not run.is_ended:
            self.node = here
            flow.go(back)

    # --- which line -------------------------------------------------------------------

    def _scan(self) -> bool:
        """Execute the lines that come next together; False if there are none."""
        flow = self._flow
        place = flow.ahead()
        if place is None or not self.scanner.is_free:
            return False
        place_after = self.scanner.read(place)
        if place_after is place:
            return False
        flow.go_place(place_after)
        return True

    def _race(self, frame: Frame | None) -> bool:
        """Execute prepared assignments and jumps, one after another.

        They are the greater part of loops. False if the frame was left.
        """
        flow, done = self._flow, self.idle_cnt
        node = flow.next
        while node is not None and (block := node.ready) is not None and done < MOST_IDLE:
            work = block.bare
            if work is None:
                break
            done += 1
            flow.pass_by(node)
            self.node = node
            try:
                work.now(node)
            except NotAtRestError:
                flow.go(node)
                done -= 1
                break
            except _ARITHMETIC as error:
                raise _undefined(error) from None
            if frame is not None and frame.is_done:
                self.idle_cnt = done
                return False
            node = flow.next
        self.idle_cnt = done
        return True

    def _fetch(self) -> Node | None:
        """The next line with an effect; None where a replay has arrived.

        After the last line the program has ended: an empty line is returned.
        """
        run, flow = self._run, self._flow
        while True:
            node = flow.following()
            if node is None:
                source = self._last_source()
                run.finish(source, is_by_code=False)
                return Node(run.program.main, source.line, "", 0)
            self.node, self.scanner.last = node, None
            if node.line == self.until and node.part is run.program.main:
                self.is_arrived = True
                return None
            block = node.ready
            if block is None:
                block = node.ready = ready(node, run)
            flow.pass_by(node)
            if block.is_empty:
                continue
            if block.plan.block.is_skippable and run.machine.is_block_skip_on():
                continue
            self.idle_cnt += 1
            if self.idle_cnt > MOST_IDLE:
                self.node = node if run.loops is None else run.loops.jump_around(node)
                raise CodeError("A62", 1)
            return node

    def _last_source(self) -> Source:
        """The last line of the program, where it ends without a code."""
        last = self.scanner.last
        node = self.node if last is None else self._flow.at(last)
        return node.source if node else Source("", 1, "")

    # --- one block --------------------------------------------------------------------

    def _is_done(self, node: Node, work: Quick) -> bool:
        """Execute at once; False if a value needs the machine at rest."""
        try:
            work.now(node)
        except NotAtRestError:
            return False
        except _ARITHMETIC as error:
            raise _undefined(error) from None
        return True

    def _context(self, node: Node, block: Ready) -> BlockContext | None:
        """The words as numbers; None where a value needs the machine at rest."""
        try:
            return BlockContext(node, block.plan, block.plan.numbers or values_of(block))
        except NotAtRestError:
            return None
        except _ARITHMETIC as error:
            raise _undefined(error) from None

    def execute(self, node: Node, block: Ready) -> Iterator[Entry]:
        """One block: read and check everything, then act."""
        for message in block.plan.block.messages:
            yield from self._say(node.source, message)
        done = 0
        words: dict[str, float] = {}
        while True:
            try:
                while done < len(block.assigns):
                    block.assigns[done](node)
                    done += 1
                if block.statement is not None:
                    asking = block.statement(node)
                    if asking is not None:
                        yield from asking
                elif block.acts:
                    words = values_of(block)
                for act in block.late:
                    act(node)
                break
            except NotAtRestError:
                yield from self._run.sync(node.source)
            except _ARITHMETIC as error:
                raise _undefined(error) from None
        waiting = self._act(BlockContext(node, block.plan, words), block.acts)
        if waiting is not None:
            yield from waiting

    def _act(self, b: BlockContext, acts: tuple[Code, ...]) -> Iterator[Entry] | None:
        """Let the codes act; what is left to be done from the first one on that waits."""
        run = self._run
        for place, code in enumerate(acts, 1):
            if code.letter == MACRO and run.macro is None:
                continue
            b.number = code.number
            waiting = code.act(run, b)
            if waiting is not None:
                return self._go_on(waiting, b, acts[place:])
        return None

    def _go_on(
        self, waiting: Iterator[Entry], b: BlockContext, acts: tuple[Code, ...]
    ) -> Iterator[Entry]:
        """The entries of a code that waits, then those of the codes after it."""
        yield from waiting
        if not self._run.is_ended:
            left = self._act(b, acts)
            if left is not None:
                yield from left

    def _say(self, source: Source, message: Message) -> Iterator[Entry]:
        """Show a text; values in it are those of the moment."""
        text = message.text
        while message.has_values:
            try:
                text = _PARAMETER.sub(self._value, message.text)
                break
            except NotAtRestError:
                yield from self._run.sync(source)
        self._run.tell(Say(source, text))

    def _value(self, found: re.Match[str]) -> str:
        parameters, grammar = self._run.parameters, self._run.dialect.grammar
        kind, digits, name = found[1].upper(), found[2], found[3]
        if kind not in grammar.parameters or (name and not grammar.has_names):
            return found[0]
        if digits is None:
            name = name.replace(" ", "").upper()
            return shown(parameters.read_named(name)) if parameters.has_named(name) else UNKNOWN
        read = parameters.read_hash if kind == "#" else parameters.read_p
        return shown(read(float(digits)))


def _undefined(error: Exception) -> CodeError:
    """A formula without a value, in words that are the same with every Python."""
    return CodeError("E210", 1, _REASONS.get(type(error)) or str(error))
