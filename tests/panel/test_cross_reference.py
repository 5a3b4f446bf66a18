"""The cross reference of the bench: the names of all programs on the card, and their uses."""

import httpx
from tests.panel.bench import Served

from openacr.client import Level
from openacr.client.stored import ListedLine
from openacr.panel.control.station import Station
from openacr.panel.server.calls.cross_reference import table


def test_names_come_before_parameters_and_flags_which_have_what_the_card_says_of_them() -> None:
    found = table(
        {
            "PROG3": [ListedLine(10, "P12288 = SPEED"), ListedLine(20, "_more")],
            "PLC0": [ListedLine(10, "LD 516 OUT 32")],
        },
        {"SPEED": "P30"},
    )
    assert [each["name"] for each in found] == [
        "PROG3 more", "SPEED", "BIT32", "BIT516", "P30", "P12288",
    ]  # fmt: skip
    assert [each["target"] for each in found] == ["", "P30", "", "", "", ""]
    items = [each["item"] for each in found]
    assert items[0] is None
    assert items[5]["name"] == "Current Position"  # type: ignore[index]
    assert found[2]["uses"] == [
        {"name": "BIT32", "program": "PLC0", "line": 10, "column": 11, "text": "LD 516 OUT 32",
         "access": "writes"},
    ]  # fmt: skip


def test_the_programs_of_the_card_are_read_with_its_aliases(kept_panel: Served) -> None:
    without = httpx.get(f"{kept_panel.url}/api/card/uses", timeout=60)  # no memory for aliases
    assert without.status_code == 200

    def store(station: Station) -> None:
        card = station.link.machine.card
        card.go(Level())
        for line in ("DIM DEF(10)", "#DEFINE SPEED P30"):
            card.command(line)
        card.download("PROGRAM\nSPEED = P31\nENDP\n", to=Level.program(3))

    kept_panel.call(store)
    answer = httpx.get(f"{kept_panel.url}/api/card/uses", timeout=60).json()
    names = {each["name"]: each for each in answer["names"]}
    assert [each["access"] for each in names["SPEED"]["uses"]] == ["writes"]
    assert names["P30"]["uses"][0]["program"] == "PROG3"
    assert [each["access"] for each in names["P31"]["uses"]] == ["reads"]
