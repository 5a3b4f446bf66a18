"""At which block the part program of the panel was, on each branch of the history of its card."""

from bisect import bisect_right
from typing import NamedTuple

MOST = 50_000  # blocks of a branch; of more, the older half is forgotten


class Block(NamedTuple):
    """From a tick on, the part program is at a line; 0: none runs."""

    tick: int
    path: str
    line: int


def _tick(block: Block) -> int:
    return block.tick


class Blocks:
    """The blocks of all branches, as the panel has noted them."""

    def __init__(self) -> None:
        self._of: dict[int, list[Block]] = {}

    def note(self, branch: int, block: Block) -> None:
        """The block that is executed now; one that is known already is not noted again."""
        known = self._of.setdefault(branch, [])
        before = known[-1] if known else Block(-1, "", 0)
        if block.tick <= before.tick or block[1:] == before[1:]:
            return
        known.append(block)
        if len(known) > MOST:
            del known[: MOST // 2]

    def at(self, branch: int, tick: int) -> Block | None:
        """The block at a tick; None where no part program ran."""
        known = self._of.get(branch, [])
        place = bisect_right(known, tick, key=_tick)
        found = known[place - 1] if place else None
        return found if found is not None and found.line else None

    def between(self, branch: int, first_tk: int, last_tk: int) -> list[Block]:
        """The blocks of a part of a branch, with the one before it."""
        known = self._of.get(branch, [])
        begin = max(0, bisect_right(known, first_tk, key=_tick) - 1)
        return known[begin : bisect_right(known, last_tk, key=_tick)]

    def fork(self, parent: int, branch: int, tick: int) -> None:
        """Another branch has begun: it shares what was before; no program is under way."""
        shared = [block for block in self._of.get(parent, []) if block.tick <= tick]
        if shared and shared[-1].line:
            shared.append(Block(tick + 1, shared[-1].path, 0))
        self._of[branch] = shared

    def forget(self, branch: int) -> None:
        """Forget a branch."""
        self._of.pop(branch, None)


def part_lanes(
    blocks: list[Block], first: int, last: int, end: int, near: int
) -> list[dict[str, object]]:
    """The lanes of the part programs of these blocks, one for each file, with their lines."""
    spans: dict[str, list[tuple[int, int]]] = {}
    slices: dict[str, list[tuple[int, int]]] = {}
    on: dict[str, int] = {}
    ends = [*(block.tick for block in blocks[1:]), min(last, end)][: len(blocks)]
    for block, until in zip(blocks, ends, strict=True):
        begin, until = max(first, block.tick), min(last, until)
        if not block.line or until <= begin:
            continue
        own, lines = spans.setdefault(block.path, []), slices.setdefault(block.path, [])
        on[block.path] = on.get(block.path, 0) + until - begin
        if not lines or begin - lines[-1][0] >= near:
            lines.append((begin, block.line))
        if own and begin - own[-1][1] <= near:
            begin = own.pop()[0]
        own.append((begin, until))
    return [
        {
            "kind": "part",
            "number": number,
            "name": path,
            "flag": None,
            "spans": spans[path],
            "on": on[path],
            "changes": sum(block.path == path and block.line > 0 for block in blocks),
            "slices": slices[path],
        }
        for number, path in enumerate(spans)
    ]
