"""`openacr mill message` and `openacr mill param`: what an operator sees and changes."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from openacr.cli.main import app
from openacr.client import Card
from openacr.controller import Controller


def mill(*words: object) -> tuple[int, str]:
    result = CliRunner().invoke(app, ["mill", *map(str, words)])
    return result.exit_code, result.output


def test_messages_are_defined_listed_and_removed() -> None:
    assert mill("message", "list") == (0, "no messages are defined\n")
    assert mill("message", "set", "coolant runs", "--bit", 41) == (0, "message 0: coolant runs\n")
    assert mill("message", "set", "lamp off", "--bit", 40, "--off", "--alarm")[0] == 0
    assert mill("message", "list") == (
        0,
        " 0  BIT41 on  coolant runs\n 1  BIT40 off lamp off  alarm\n",
    )
    (first, _) = json.loads(mill("message", "list", "--json")[1])
    assert (first["bit"], first["shown_while"], first["size"]) == (41, "on", 12)
    assert mill("message", "remove", 0)[0] == 0
    assert mill("message", "remove", 0) == (2, "error: message 0 is not defined\n")


def test_messages_that_are_none() -> None:
    assert mill("message", "set", "x", "--bit", 99999)[1] == (
        "error: --bit 99999: the card has no such flag\n"
    )
    assert (
        "message 32: messages are numbered 0 to 31"
        in mill("message", "set", "x", "--bit", 5, "--number", 32)[1]
    )
    assert "0 to 15" in mill("message", "set", "x", "--bit", 5, "--color", 16)[1]


@pytest.mark.req("MILL-MSG-TRIGGER")
def test_a_run_shows_messages_and_lists_them(tmp_path: Path) -> None:
    part = tmp_path / "P.NC"
    part.write_text("M8\nG4 F1\nM9\nG4 F1\nM2\n")
    settings = ["sysvar", "set", "coolant flood output=41"]
    assert CliRunner().invoke(app, settings).exit_code == 0
    mill("message", "set", "coolant runs", "--bit", 41, "--alarm")
    code, text = mill("run", part)
    assert code == 0
    assert "message 0: coolant runs" in text
    assert "message 0: coolant runs (over)" in text
    result = CliRunner().invoke(app, ["mill", "run", str(part), "--json"])
    record = json.loads(result.stdout)
    (shown,) = record["messages"]
    assert shown["until_s"] - shown["at_s"] == pytest.approx(1.0, abs=0.1)
    assert [alarm["code"] for alarm in record["alarms"]] == [50]


@pytest.mark.req("MILL-PPARM-P100")
def test_variables_of_the_store_are_shown_and_changed() -> None:
    assert mill("param", "P100=4.5", "p101=-1") == (0, "P100 = 4.5\nP101 = -1\n")
    assert mill("param", "P100") == (0, "P100 = 4.5\n")
    shown = mill("param")[1].splitlines()
    assert (shown[0], len(shown)) == ("P100 = 4.5", 100)
    assert mill("param", "P5")[1] == "error: P5 is on the card: name the card with --host\n"
    assert "not an operator variable: P0 to P199 are" in mill("param", "P200=1")[1]
    for wrong in ("P100=x", "P100=inf", "hello", "P100="):
        assert "write P5 to see it" in mill("param", wrong)[1]


@pytest.mark.req("MILL-PPARM-LIVE")
def test_variables_of_a_card_are_made_where_there_are_none(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    controller, opened = Controller(), Card.open
    monkeypatch.setattr(Card, "open", lambda _target: opened(controller))
    for words, shown in ((["P5=2.5"], "P5 = 2.5\n"), (["P5", "P99"], "P5 = 2.5\nP99 = 0\n")):
        assert mill("param", *words, "--host", "card") == (0, shown)
    assert len(mill("param", "--host", "card")[1].splitlines()) == 200
