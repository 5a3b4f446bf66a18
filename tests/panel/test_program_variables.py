"""Variables, flow stack and waits of programs of the card at the screens."""

from collections.abc import Iterator
from typing import Any

import httpx
import pytest
from tests.panel.bench import HandStation, Served

from openacr.client import Level
from openacr.client.program_variables import Value, dimensioned, variables
from openacr.client.stored import ListedLine
from openacr.debugger.variables import local_text
from openacr.panel.server.calls.variables import NO_STACK, used

NESTED = (
    "PROGRAM\nDIM LV(2)\nDIM DA(1)\nDIM DA0(2)\nDIM $V(1,9)\nLV0 = 7\nDA0(1) = 2.5\n"
    '$V0 = "go"\nFOR LV1 = 1 TO 3 STEP 1\nGOSUB sub\nNEXT\nEND\n_sub\nIF (P5 < 1)\nINH 130\n'
    "ENDIF\nRETURN\nENDP\n"
)


def read(hand: HandStation) -> list[Value]:
    future = hand.station.on_card.aside.begin(lambda talk: variables(talk, 3))
    hand.until(future.done)
    return future.result()


def running(hand: HandStation) -> None:
    hand.do("card.send", program=3, text=NESTED)
    hand.do("card.run", program=3)
    hand.run(0.3)


def test_variables_and_arrays_of_a_program_are_read_and_changed(hand: HandStation) -> None:
    running(hand)
    assert read(hand) == [
        Value("LV0", "7"), Value("LV1", "1"),
        Value("$V0", "'go'"),
        Value("DA0", "2 elements", (Value("DA0(0)", "0"), Value("DA0(1)", "2.5"))),
    ]  # fmt: skip
    for name, value, now in (
        ("LV0", "2*4", "8"), ("DA0(1)", "-1.5", "-1.5"), ("$V0", '"a:b"', "a:b"),
    ):  # fmt: skip
        assert hand.do("card.assign", program=3, name=name, value=value) == {"value": now}


@pytest.mark.parametrize(
    ("name", "value", "why"),
    [
        ("LV0", "1 : HALT ALL", "1 : HALT ALL: a value is one expression, without a colon"),
        ("LV9", "1", "LV9=1: Undefined variable"),
        ("P0", "1", None),
        ("LV0 = 1 : X", "1", None),
        ("LV0", "1\rHALT ALL", None),
    ],
)
def test_nothing_but_a_variable_is_changed(
    hand: HandStation, name: str, value: str, why: str | None
) -> None:
    running(hand)
    error = hand.refused("card.assign", program=3, name=name, value=value)
    assert (error["code"], why or error["text"]) == (
        "refused" if why else "bad", error["text"],
    )  # fmt: skip
    assert read(hand)[0] == Value("LV0", "7")


def test_variables_of_the_programs_of_this_machine_are_left_alone(hand: HandStation) -> None:
    error = hand.refused("card.assign", program=7, name="LV0", value="1")
    assert error["text"] == "PROG7 of the card belongs to this machine"


def test_parameters_and_flags_of_a_text_are_listed_once_by_number() -> None:
    text = ["IF (P5 < P12288) THEN SET 130", "LV0 = P5 + BIT516", "' P6", "LA0(P5) = 1"]
    found = used([ListedLine(10 * n, line) for n, line in enumerate(text, 1)])
    assert [each["id"] for each in found] == ["P5", "P12288", "BIT130", "BIT516"]


ASKED = ("LV0", "LV1", "LV2", "DA0(0)", "DA0(1)", "DA0(2)", "DA1(0)", "$V0", "$V1", "SV0", "$A0(0)")
GIVEN = {"LV0": "7", "LV1": "1", "DA0(0)": "0", "DA0(1)": "2.5", "$V0": "'go'"}


def test_chosen_variables_and_elements_are_read_and_those_without_memory_left_out(
    hand: HandStation,
) -> None:
    running(hand)
    future = hand.station.on_card.aside.begin(lambda talk: dimensioned(talk, 3, ASKED))
    hand.until(future.done)
    assert future.result() == GIVEN
    card = hand.station.installation.controller
    assert card is not None
    held = {each: local_text(card, 3, each) for each in ASKED}
    assert held == {**dict.fromkeys(ASKED), **GIVEN}
    assert [local_text(card, 3, each) for each in ("P0", "LV0+1", "LA0", "LV0(0)")] == [None] * 4


@pytest.fixture
def web(panel: Served) -> Iterator[tuple[Served, httpx.Client]]:
    with httpx.Client(base_url=f"{panel.url}/api", timeout=None) as client:
        yield panel, client


def test_the_flow_stack_and_the_wait_of_a_program_are_read(
    web: tuple[Served, httpx.Client], monkeypatch: pytest.MonkeyPatch
) -> None:
    served, client = web

    def begin(card: Any) -> None:
        card.download(NESTED, to=Level.program(3))
        card.command("RUN PROG3")

    served.call(lambda station: begin(station.link.machine.card))
    while not (found := client.get("/card/variables", params={"program": 3}).json())["levels"][2:]:
        pass
    assert found["state"] == "inhibited"
    assert found["levels"] == [
        {"word": "FOR", "line": 90}, {"word": "GOSUB", "line": 100}, {"word": "IF", "line": 140},
    ]  # fmt: skip
    assert [each["name"] for each in found["variables"]] == ["LV0", "LV1", "$V0", "DA0"]
    items = client.get("/card/used", params={"program": 3}).json()["items"]
    assert [each["id"] for each in items] == ["P5", "BIT130"]
    monkeypatch.setattr(served.station.installation, "history", None)
    found = client.get("/card/variables", params={"program": 3}).json()
    assert (found["levels"], found["why"], found["state"]) == ([], NO_STACK, "")
    refused = client.get("/card/variables", params={"plc": 0}).json()["error"]
    assert refused["text"] == "PLC0: only programs have variables of their own"
    monkeypatch.undo()
    three = "/card/values?program=3&names="
    values = {"values": {"LV1": "1", "DA0(1)": "2.5"}}
    assert client.get(f"{three}LV1;DA0(1);LV2").json() == values
    monkeypatch.setattr(type(served.station.installation), "controller", None)  # as over a link
    assert client.get(f"{three}LV1;DA0(1);LV2").json() == values
    monkeypatch.undo()
    for wrong in ("LV0;?P0", "P0", "LV0;", ""):
        assert client.get(f"{three}{wrong}").json()["error"]["code"] == "bad"
