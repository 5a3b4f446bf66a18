"""The same life on the compiled and the pure core, and from any snapshot, ends the same."""

from functools import cache

import pytest
from tests.parity.journeys import JOURNEYS, card, live, random_split, take
from tests.parity.plain import printed_by_plain_python

from openacr import compiled


@cache
def lived(name: str) -> list[str]:
    """The digests of a journey, lived once for all tests."""
    return list(live(name))


@pytest.mark.skipif(not compiled.is_compiled, reason="needs both builds")
def test_both_builds_live_the_same_life() -> None:
    assert printed_by_plain_python("tests.parity.journeys") == {
        name: lived(name) for name in JOURNEYS
    }


@pytest.mark.parametrize("name", JOURNEYS)
def test_a_life_repeats_itself(name: str) -> None:
    assert list(live(name)) == lived(name)
    assert len(set(lived(name))) == len(lived(name))  # every step has an effect


@pytest.mark.parametrize("name", JOURNEYS)
def test_a_life_continued_from_a_snapshot_ends_the_same(name: str) -> None:
    """At random ticks the card returns to a snapshot, after having gone astray."""
    expected = lived(name)
    made = card()
    for number, step in enumerate(JOURNEYS[name]):
        for piece in random_split(step, number) if isinstance(step, int) else [step]:
            snapshot = made.snapshot()
            made.set_input(7, True)
            made.advance(13 + number)
            made.restore(snapshot)
            take(made, piece)
        assert made.digest() == expected[number], step


def test_ticks_in_pieces_are_the_same_ticks() -> None:
    whole, pieces = card(), card()
    for made in (whole, pieces):
        take(made, "X0.2 Y0.1")
    whole.advance(300)
    for piece in random_split(300, 3):
        pieces.advance(piece)
    assert whole.digest() == pieces.digest()
