"""Lines of controller files that belong together: programs, blocks, remarks."""

from collections.abc import Iterator

from openacr.editing.controller.outline import Outline
from openacr.editing.outlines import COMMENT, REGION, Fold


def folds(outline: Outline) -> Iterator[Fold]:
    """Programs from PROGRAM to ENDP, blocks, and remarks of several lines."""
    program = -1
    blocks: list[int] = []
    remark = last_remark = -2
    for line, facts in outline.facts:
        if facts.is_remark:
            if line != last_remark + 1:
                yield from _fold(remark, last_remark, COMMENT)
                remark = line
            last_remark = line
            continue
        if facts.opens_program or facts.level is not None:
            blocks.clear()
            program = line if facts.opens_program else -1
        if facts.ends_program:
            yield from _fold(program, line, REGION)
            program = -1
        for _ in range(min(facts.closes, len(blocks))):
            yield from _fold(blocks.pop(), line, "")
        blocks += [line] * facts.opens
    yield from _fold(remark, last_remark, COMMENT)


def _fold(first: int, last: int, kind: str) -> Iterator[Fold]:
    if 0 <= first < last:
        yield Fold(first, last, kind)
