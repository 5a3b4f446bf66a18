"""Thousands of random contours, judged by shapely."""

import random
from itertools import pairwise
from math import pi

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from tests.cnc.compensation.oracle import (
    contour,
    is_beside,
    least_distance,
    line_of,
    mirrored,
    rotated,
    sagitta,
    star,
)
from tests.cnc.compensation.tools import EXACT, Path, Trace, compensate
from tests.search import search, sparse

from openacr.cnc.compensation import Rules, Side
from openacr.cnc.geometry.elements import Element

pytestmark = pytest.mark.evidence("oracle", "random contours and offsets of shapely")

BUNDLES = 8
CONTOURS = 400  # in a bundle
CLOSE = 2e-6
ADJUSTED = {"E320", "E321", "E322", "W320"}
LEAVING_OUT = Rules(EXACT.epsilon, EXACT.sweep_epsilon, EXACT.root_epsilon, gouge_stop=False)


def any_contour(rnd: random.Random) -> Path:
    arcs = rnd.choice((0.0, 0.5, 1.0))
    if rnd.random() < 0.5:
        return contour(rnd, rnd.randint(1, 7), arcs=arcs, turn=rnd.choice((0.5, 1.5, 3.1)))
    return star(rnd, rnd.randint(3, 9), arcs=arcs)


def any_radius(rnd: random.Random) -> float:
    return rnd.choice((0.01, 0.03, 0.1, 0.25, 1.0)) * rnd.uniform(0.7, 1.2)


def is_joined(trace: Trace) -> bool:
    """Whether every move starts where the one before ended."""
    return all(
        one.end == pytest.approx(other.start, abs=CLOSE) for one, other in pairwise(trace.elements)
    )


def keeps_off(trace: Trace, elements: list[Element], radius: float) -> bool:
    """Whether moves beside elements, where nothing was inserted, keep the radius from them."""
    contours = {each.source.line: each for each in elements[1:-1]}
    paths = [path for path in trace.elements[1:-1] if not path.is_inserted]
    return all(is_beside(path, contours[path.source.line], radius, CLOSE) for path in paths)


@pytest.mark.parametrize("bundle", sparse(range(BUNDLES), 4))
def test_the_tool_keeps_its_radius_or_the_gouge_is_reported(bundle: int) -> None:
    """What is not reported is right; what is reported as too near is too near."""
    clean = 0
    for seed in range(bundle * CONTOURS, (bundle + 1) * CONTOURS):
        rnd = random.Random(seed)
        elements, radius, side = any_contour(rnd).elements, any_radius(rnd), rnd.choice([*Side])
        trace = compensate(elements, radius, side, is_checked=True)
        assert is_joined(trace), seed
        near, uncertain = least_distance(trace.elements, elements[1:-1], radius)
        codes = set(trace.codes)
        if not codes & ADJUSTED:
            assert keeps_off(trace, elements, radius), seed
            if "W323" in codes:
                assert near <= radius + uncertain, seed
            else:
                clean += 1
                assert near >= radius - uncertain - CLOSE, seed
    assert clean > CONTOURS / 10


@pytest.mark.parametrize("bundle", sparse(range(3), 2))
def test_closed_contours_are_followed_as_shapely_offsets_them(bundle: int) -> None:
    compared = 0
    for seed in range(bundle * 60, (bundle + 1) * 60):
        rnd = random.Random(seed)
        elements = star(rnd, rnd.randint(3, 8), arcs=rnd.choice((0.0, 0.3, 1.0))).elements
        radius, side = rnd.uniform(0.02, 0.5), rnd.choice([*Side])
        trace = compensate(elements, radius, side, is_checked=True)
        ring = shapely.Polygon(line_of(elements[1:-1]).coords)
        if set(trace.codes) - {"W311", "W312"} or not ring.is_valid:
            continue
        wanted = ring.buffer(-radius if side is Side.LEFT else radius, quad_segs=64)
        followed = line_of(trace.elements[1:-1])
        slack = radius * (1 - np.cos(pi / 256)) + sagitta(elements) + sagitta(trace.elements)
        assert shapely.hausdorff_distance(followed, wanted.boundary, 0.05) <= slack + CLOSE, seed
        compared += 1
    assert compared > 15


@search(100)
@given(st.integers(0, 10**9), st.floats(-pi, pi))
def test_a_turned_contour_gives_the_turned_path(seed: int, angle: float) -> None:
    rnd = random.Random(seed)
    elements, radius = any_contour(rnd).elements, any_radius(rnd)
    straight = compensate(elements, radius)
    turned = compensate(rotated(elements, angle), radius)
    assert turned.codes == straight.codes
    for one, other in zip(rotated(straight.elements, angle), turned.elements, strict=True):
        assert one.end == pytest.approx(other.end, abs=1e-5)
        assert one.sweep_rad == pytest.approx(other.sweep_rad, abs=1e-3)


@search(100)
@given(st.integers(0, 10**9))
def test_the_mirrored_contour_with_the_negative_radius_gives_the_mirrored_path(seed: int) -> None:
    rnd = random.Random(seed)
    elements, radius = any_contour(rnd).elements, any_radius(rnd)
    left = compensate(elements, radius)
    right = compensate(mirrored(elements), -radius)
    assert right.codes == ["W310", *left.codes]
    for one, other in zip(mirrored(left.elements), right.elements, strict=True):
        assert one.end == pytest.approx(other.end, abs=1e-9)
        assert one.is_inserted is other.is_inserted


@search(100)
@given(st.integers(0, 10**9))
def test_with_gouge_stop_off_the_path_stays_in_one_piece(seed: int) -> None:
    rnd = random.Random(seed)
    elements, radius = any_contour(rnd).elements, any_radius(rnd)
    trace = compensate(elements, radius, rules=LEAVING_OUT)
    assert is_joined(trace)
    assert trace.elements[-1].end == elements[-1].end


def test_a_narrow_neck_is_found_with_both_lines() -> None:
    # A slot 0.4 wide between elements far apart in the program.
    path = Path(-1, -2).to(0, -1).to(3, -1).to(3, 1).to(1, 1).to(1, 0.2).to(0.6, 0.2)
    path.to(0.6, 1).to(0, 1).to(0, -1).to(-1, -2)
    trace = compensate(path.elements, 0.15, Side.RIGHT, is_checked=True)
    assert trace.codes == []
    trace = compensate(path.elements, 0.25, Side.RIGHT, is_checked=True)
    assert "E322" in trace.codes
    neck = Path(-1, 2).to(0, 0).to(3, 0).to(3, 1).to(4, 1).to(4, 0.3).to(6, 0.3).to(6, 3)
    neck.to(2.7, 3).to(2.7, 0.7).to(0, 0.7).to(-1, 2)
    trace = compensate(neck.elements, 0.2, is_checked=True)
    assert {"W323"} <= set(trace.codes)
    assert "its radius is 0.2" in next(t for c, t, _ in trace.findings if c == "W323")
