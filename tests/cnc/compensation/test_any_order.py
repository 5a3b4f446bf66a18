"""Programs that switch, change, stop and wait at any place: the tool's path stays in one piece."""

import random
from itertools import pairwise
from math import atan2, dist, isfinite, remainder, tau

import pytest
from msgspec.structs import replace
from tests.cnc.compensation.oracle import contour
from tests.cnc.compensation.tools import EXACT, Trace

from openacr.cnc.compensation import Compensator, Rules, Side
from openacr.cnc.geometry.elements import Element

pytestmark = pytest.mark.evidence("oracle", "random contours and offsets of shapely")

PROGRAMS = 250  # in a bundle
CLOSE = 3e-6
ALL_RULES = (Rules(), Rules(gouge_stop=False), EXACT, Rules(1e-5, 0.01, -12, False), Rules(0.1))


def program(rnd: random.Random) -> list[Element]:
    """A contour with numbers of a few decimals, as programs have them."""
    decimals = rnd.choice((3, 5, 17))
    path = contour(rnd, rnd.randint(1, 12), arcs=rnd.choice((0, 0.5, 1)), turn=3.1)
    elements: list[Element] = []
    for each in path.elements:
        start = elements[-1].end if elements else each.start
        end = tuple(round(x, decimals) for x in each.end)
        elements.append(_with_sweep(replace(each, start=start, end=end)))
    return elements


def _with_sweep(element: Element) -> Element:
    """The sweep that belongs to the rounded ends."""
    if element.centre is None:
        return element
    (x0, y0), (x1, y1), (cx, cy) = element.start[:2], element.end[:2], element.centre
    if min(dist((x0, y0), (cx, cy)), dist((x1, y1), (cx, cy))) < 1e-3:
        return replace(element, centre=None, sweep_rad=0.0)
    turn = atan2(y1 - cy, x1 - cx) - atan2(y0 - cy, x0 - cx)
    turn += tau * round((element.sweep_rad - turn) / tau)
    if turn * element.sweep_rad <= 0.0:
        return replace(element, centre=None, sweep_rad=0.0)
    return replace(element, sweep_rad=turn)


def interfere(
    rnd: random.Random, compensator: Compensator[str], last: Element, trace: Trace
) -> int:
    """Something that stands between two moves; how many things were held."""
    radius = rnd.uniform(0.01, 0.5)
    what = rnd.random()
    if what < 0.1:
        trace.out += compensator.flush()
    elif what < 0.2:
        trace.out += compensator.switch(rnd.choice([*Side]), radius)
    elif what < 0.35:
        trace.out += compensator.hold("held", is_after=rnd.random() < 0.5)
        return 1
    elif what < 0.4:
        end = (*last.end[:2], rnd.random(), *last.end[3:])
        trace.out += compensator.add(
            replace(last, start=last.end, end=end, centre=None, sweep_rad=0.0)
        )
    elif what < 0.42:
        trace.out += compensator.switch(None)
        trace.out += compensator.switch(Side.LEFT, -radius)
    return 0


def check(element: Element) -> None:
    numbers = (*element.start, *element.end, element.sweep_rad, *(element.centre or ()))
    assert all(map(isfinite, numbers))
    if element.centre is not None:
        (x0, y0), (x1, y1), (cx, cy) = element.start[:2], element.end[:2], element.centre
        turn = atan2(y1 - cy, x1 - cx) - atan2(y0 - cy, x0 - cx)
        off = abs(remainder(turn - element.sweep_rad, tau))
        assert off * dist((x1, y1), (cx, cy)) < CLOSE
        assert abs(element.sweep_rad) <= tau + 1e-9


@pytest.mark.parametrize("bundle", range(4))
def test_whatever_stands_between_moves_the_path_stays_in_one_piece(bundle: int) -> None:
    for seed in range(bundle * PROGRAMS, (bundle + 1) * PROGRAMS):
        rnd = random.Random(seed)
        elements, trace, held_cnt = program(rnd), Trace(), 0
        compensator: Compensator[str] = Compensator(rnd.choice(ALL_RULES), trace.report)
        trace.out += compensator.switch(rnd.choice([*Side]), rnd.uniform(0.0, 0.5))
        for element in elements[:-1]:
            trace.out += compensator.add(element)
            held_cnt += interfere(rnd, compensator, element, trace)
        trace.out += compensator.switch(None)
        trace.out += compensator.add(elements[-1])
        trace.out += compensator.stop()
        assert trace.out.count("held") == held_cnt, seed
        if {"E313", "E315"} & set(trace.codes):
            continue
        assert trace.elements[-1].end == elements[-1].end, seed
        for one, other in pairwise(trace.elements):
            assert dist(one.end[:2], other.start[:2]) < CLOSE, seed
        for element in trace.elements:
            check(element)
