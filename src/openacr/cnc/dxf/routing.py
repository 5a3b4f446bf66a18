"""Tool paths through the chains of a drawing: insides first, compensated or not."""

from collections.abc import Sequence
from dataclasses import dataclass

from openacr.cnc.dxf.chains import ORIGIN, Chain, in_order, turned
from openacr.cnc.dxf.leads import Led, led
from openacr.cnc.dxf.nesting import Edges, depths, outline, parents

Way = Chain | Led


@dataclass(frozen=True, slots=True)
class Tool:
    """A tool to compensate for, in the unit of the drawing."""

    d_number: int
    radius: float
    lead: float  # radius of the ways in and out


@dataclass(frozen=True, slots=True)
class Route:
    """Ways in their order, and what is to be said about them."""

    ways: list[Way]
    notes: list[str]


def routed(chains: Sequence[Chain], tool: Tool | None) -> Route:
    """What lies inside a chain is cut before it; of what may come next, the nearest start.

    With a tool, closed chains are compensated: it stays outside outlines and inside holes.
    """
    outlines = [outline(chain) for chain in chains]
    around = parents(chains, outlines)
    ways: list[Way | None] = list(chains)
    if tool is not None:
        edges = Edges(outlines)
        for number, (chain, depth) in enumerate(zip(chains, depths(around), strict=True)):
            if chain.is_closed:
                is_hole = depth % 2 == 1
                ways[number] = led(
                    chain, edges, is_hole=is_hole, radius=tool.radius, lead=tool.lead
                )
    here, ordered = ORIGIN, []
    for number in in_order([_chain(way, chains[k]) for k, way in enumerate(ways)], parents=around):
        way = ways[number]
        if isinstance(way, Chain):
            way = turned(way, here)
        if way is not None:
            here = _chain(way, chains[number]).end
            ordered.append(way)
    return Route(ordered, _notes(chains, ways, tool))


def _chain(way: Way | None, chain: Chain) -> Chain:
    return way.chain if isinstance(way, Led) else chain


def _notes(chains: Sequence[Chain], ways: Sequence[Way | None], tool: Tool | None) -> list[str]:
    if tool is None:
        return []
    notes = []
    for chain, way in zip(chains, ways, strict=True):
        if way is None:
            x, y = chain.start
            notes.append(
                f"left out: a chain at {x:g}, {y:g}: D{tool.d_number} has no room beside it"
            )
    count = sum(not chain.is_closed for chain in chains)
    if count:
        notes.append(f"open chains are not compensated: {count}")
    return notes
