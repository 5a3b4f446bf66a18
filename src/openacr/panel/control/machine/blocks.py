"""At which block the part program of the panel was, on each branch of the history of its card."""

from typing import NamedTuple

from openacr.panel.control.machine.branch_notes import BranchNotes

MOST = 50_000  # blocks of a branch


class Block(NamedTuple):
    """From a tick on, the part program is at a line; 0: none runs."""

    tick: int
    path: str
    line: int


class Blocks(BranchNotes[Block]):
    """The blocks of all branches."""

    def __init__(self) -> None:
        super().__init__(MOST)

    def note(self, branch: int, noted: Block) -> None:
        """The block that is executed now; one that is known already is not noted again."""
        before = self.last(branch) or Block(-1, "", 0)
        if noted.tick > before.tick and noted[1:] != before[1:]:
            super().note(branch, noted)

    def at(self, branch: int, tick: int) -> Block | None:
        """The block at a tick; None where no part program ran."""
        found = super().at(branch, tick)
        return found if found is not None and found.line else None

    def fork(self, parent: int, branch: int, tick: int) -> None:
        """Another branch has begun: it shares what was before; no program is under way."""
        super().fork(parent, branch, tick)
        shared = self.last(branch)
        if shared is not None and shared.line:
            super().note(branch, Block(tick + 1, shared.path, 0))


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
