"""Tool paths through the chains of a drawing: insides first, compensated or not."""

from collections.abc import Sequence
from dataclasses import dataclass

from openacr.cnc.dxf.chains import ORIGIN, Chain, in_order, turned
from openacr.cnc.dxf.leads import Led, led
from openacr.cnc.dxf.nesting import Edges, depths, outline, parents

CutPath = Chain | Led


@dataclass(frozen=True, slots=True)
class Tool:
    """A tool to compensate for, in the unit of the drawing."""

    d_number: int
    radius: float
    lead: float  # radius of lead-in and lead-out


@dataclass(frozen=True, slots=True)
class Route:
    """Paths in their order, and notes for the user."""

    paths: list[CutPath]
    notes: list[str]


def routed(chains: Sequence[Chain], tool: Tool | None) -> Route:
    """Order the chains: those inside a chain before it, of the possible ones the nearest start.

    With a tool, closed chains are compensated: it stays outside outlines and inside holes.
    """
    outlines = [outline(chain) for chain in chains]
    around = parents(chains, outlines)
    paths: list[CutPath | None] = list(chains)
    if tool is not None:
        edges = Edges(outlines)
        for number, (chain, depth) in enumerate(zip(chains, depths(around), strict=True)):
            if chain.is_closed:
                is_hole = depth % 2 == 1
                paths[number] = led(
                    chain, edges, is_hole=is_hole, radius=tool.radius, lead=tool.lead
                )
    here, ordered = ORIGIN, []
    for number in in_order(
        [_chain(path, chains[k]) for k, path in enumerate(paths)], parents=around
    ):
        path = paths[number]
        if isinstance(path, Chain):
            path = turned(path, here)
        if path is not None:
            here = _chain(path, chains[number]).end
            ordered.append(path)
    return Route(ordered, _notes(chains, paths, tool))


def _chain(path: CutPath | None, chain: Chain) -> Chain:
    return path.chain if isinstance(path, Led) else chain


def _notes(
    chains: Sequence[Chain], paths: Sequence[CutPath | None], tool: Tool | None
) -> list[str]:
    if tool is None:
        return []
    notes = []
    for chain, path in zip(chains, paths, strict=True):
        if path is None:
            x, y = chain.start
            notes.append(
                f"left out: a chain at {x:g}, {y:g}: D{tool.d_number} has no room beside it"
            )
    count = sum(not chain.is_closed for chain in chains)
    if count:
        notes.append(f"open chains are not compensated: {count}")
    return notes
