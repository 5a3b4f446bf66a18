"""Programs that a terminal or another host has stored are known to the screens without READ."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.mill.live import Plant
from tests.panel.bench import HandStation, card_of
from tests.panel.remote import Remote
from tests.waiting import until

from openacr.client import Card

TEXT = ("PROGRAM", "P0 = 1", "ENDP")
DEEPER = ("PROGRAM", "DWL 3", "GOSUB sub", "END", "_sub", "DWL 9", "RETURN", "ENDP")


@pytest.fixture
def other(hand: HandStation) -> Iterator[Card]:
    """A second host of the card; a screen shows the programs."""
    hand.do("watch.begin", topic="programs", hz=10)
    hand.run(0.2)
    with Card.open(card_of(hand)) as card:
        yield card


def store(card: Card, program: int, *lines: str) -> None:
    for line in lines:
        card.command(line, program=program)


def reported(hand: HandStation) -> list[str]:
    return [event["name"] for event in hand.events("texts")]


def test_a_program_of_another_host_is_reported_with_its_name(
    hand: HandStation, other: Card
) -> None:
    hand.run(5.0)
    assert reported(hand) == []
    store(other, 3, *TEXT)
    hand.until(lambda: bool(reported(hand)))
    assert reported(hand) == ["PROG3"]
    store(other, 3, "NEW")
    store(other, 2, *TEXT)
    hand.until(lambda: len(reported(hand)) > 1)
    hand.run(5.0)
    assert reported(hand) == ["PROG3", ""]  # several


def test_what_a_running_program_takes_and_gives_back_is_no_new_text(
    hand: HandStation, other: Card
) -> None:
    store(other, 3, *DEEPER)
    hand.until(lambda: bool(reported(hand)))
    other.run(3)
    hand.run(8.0)  # in its subprogram
    other.command("HALT PROG3")
    hand.run(5.0)
    assert reported(hand) == ["PROG3"]


def test_so_is_one_of_a_card_over_a_link(tmp_path: Path) -> None:
    (tmp_path / "panel").mkdir()
    plant = Plant(tmp_path)
    try:
        panel = Remote(plant.address, tmp_path / "panel", is_agreed=False)
        try:
            assert panel.send("watch.begin", topic="programs", hz=10)["ok"]
            until(lambda: panel.call(lambda station: bool(station.on_card.texts_seen.known)))
            store(plant.card, 3, *TEXT)
            until(lambda: {"event": "texts", "name": "PROG3"} in panel.events)
        finally:
            panel.close()
    finally:
        plant.close()
