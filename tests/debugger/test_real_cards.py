"""The debugger of a card over a link: a served card in another process, over TCP."""

import signal
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.debugger.client import LIMIT_S, Client, RefusedError
from tests.debugger.served import Relay, Served, flags, is_moving, is_running
from tests.waiting import until

from openacr.client import Card, Level
from openacr.debugger.real_cards import followers
from openacr.map.words import pf

HOLDS = pf.PAUSE_CONTROL | pf.BLOCK_CONTROL


@pytest.fixture
def served(tmp_path: Path) -> Iterator[Served]:
    served = Served(tmp_path / "project")
    yield served
    if served.process.poll() is None:
        served.kill()


@pytest.fixture
def card(served: Served) -> Iterator[Card]:
    """What another host sees of it."""
    with Card.open(served.address) as card:
        yield card


def begin(client: Client, served: Served, request: str = "launch", **arguments: object) -> None:
    client.ask("initialize", adapterID="openacr")
    client.event("initialized")
    client.ask(request, **({"host": served.address} | arguments))
    client.ask("configurationDone")


def test_a_session_with_a_card_from_its_beginning_to_its_end(
    client: Client, served: Served, card: Card
) -> None:
    begin(client, served, run=[0], stopOnEntry=True)
    capabilities = client.event("capabilities")["capabilities"]
    assert (capabilities["supportsStepBack"], capabilities["supportsDataBreakpoints"]) == (
        False, False,
    )  # fmt: skip
    assert client.stop() == ("entry", 1)
    names = [(each["id"], each["name"]) for each in client.ask("threads")["threads"]]
    assert names == [
        (1, "PROG0"),
        (2, "PROG1"),
        (3, "PROG2"),
        (4, "PROG3"),
        (5, "PROG4"),
        (17, "PLC0"),
    ]
    assert client.place(1) == ("PROG0 (listing)", 1)
    text = client.ask("source", sourceReference=1)["content"].splitlines()
    assert (text[0], text[5]) == ("10 PROGRAM", "60 P0 = P0+1")
    for line in (1, 2, 3, 4, 6):  # the line that was executed last; labels are no steps
        client.ask("next", threadId=1)
        assert client.stop() == ("step", 1)
        assert client.place(1) == ("PROG0 (listing)", line)
    assert client.value("P0") == "1"
    assert client.value("LV1") == "0"
    client.ask("stepIn", threadId=1)
    assert client.stop() == ("step", 1)
    assert client.value("LV1") == "2"
    answer = client.ask("continue", threadId=1)
    assert answer == {"allThreadsContinued": False}
    until(lambda: float(card.read(0)) > 10, "it goes on")
    client.ask("pause", threadId=1)
    assert client.stop() == ("pause", 1)
    held = card.read(0)
    client.ask("setExpression", expression="P0", value="500", frameId=100)
    assert (held < 500, card.read(0)) == (True, 500)
    assert client.end() == 0
    until(lambda: not is_running(card, 0), "the program that was started is ended")
    assert flags(card, 0) & HOLDS == 0


def test_a_program_that_runs_already_is_paused_alone_and_left_as_it_is(
    client: Client, served: Served, card: Card
) -> None:
    card.run(0)
    card.run(2)
    until(lambda: is_moving(card), "motion")
    begin(client, served, "attach")
    client.ask("pause", threadId=1)
    body = client.event("stopped")
    assert (body["reason"], body["threadId"], body["allThreadsStopped"]) == ("pause", 1, False)
    assert (is_running(card, 2), is_moving(card)) == (True, True)
    assert client.end() == 0
    assert flags(card, 0) & (HOLDS | pf.PROGRAM_RUNNING) == pf.PAUSE_CONTROL | pf.PROGRAM_RUNNING
    assert (is_running(card, 2), is_moving(card)) == (True, True)


def test_a_program_that_is_held_already_is_a_stop_and_goes_on_by_continue(
    client: Client, served: Served, card: Card
) -> None:
    card.run(0)
    card.command("PAUSE PROG0")
    begin(client, served, "attach")
    assert client.stop() == ("pause", 1)
    client.ask("next", threadId=1)
    assert client.stop() == ("step", 1)
    assert flags(card, 0) & HOLDS == pf.BLOCK_CONTROL
    client.ask("continue", threadId=1)
    assert flags(card, 0) & (HOLDS | pf.BLOCK_MODE | pf.PAUSE_MODE) == 0
    assert client.end() == 0
    assert is_running(card, 0)


def test_a_step_of_a_program_paused_within_a_line_completes_that_line_alone(
    client: Client, served: Served, card: Card
) -> None:
    card.run(3)
    until(lambda: bool(flags(card, 3) & pf.PROGRAM_INHIBITED), "the program waits")
    begin(client, served, "attach")
    client.ask("pause", threadId=4)
    assert client.event("stopped")["text"] == "within a line that waits"
    client.ask("next", threadId=4)
    card.write_bit(128, True)
    assert client.stop() == ("step", 4)
    assert (client.place(4), card.read(1)) == (("PROG3 (listing)", 2), 0)
    client.ask("next", threadId=4)
    assert client.stop() == ("step", 4)
    assert (client.place(4), card.read(1)) == (("PROG3 (listing)", 3), 1)


def test_what_a_program_prints_is_shown_and_its_error_is_a_stop(
    client: Client, served: Served
) -> None:
    begin(client, served, run=[1])
    assert client.event("output")["output"].startswith("HELLO\n")
    assert client.stop() == ("exception", 2)
    found = client.ask("exceptionInfo", threadId=2)["description"]
    assert found == "Error in PROG1 line 30: Divide by zero"
    assert client.place(2) == ("PROG1 (listing)", 3)
    scopes = client.ask("scopes", frameId=200)["scopes"]
    reference = {each["name"]: each["variablesReference"] for each in scopes}["Program"]
    about = client.ask("variables", variablesReference=reference)["variables"]
    assert [(each["name"], each["value"]) for each in about] == [
        ("state", "halted"), ("line executed last", "30"), ("error", found),
    ]  # fmt: skip
    assert client.end() == 0


def test_errors_are_no_stops_where_their_filter_is_off(client: Client, served: Served) -> None:
    client.ask("initialize", adapterID="openacr")
    client.ask("launch", host=served.address, run=[1])
    client.ask("setExceptionBreakpoints", filters=[])
    client.ask("configurationDone")
    texts = ""
    while "PROG1 has ended" not in texts:
        texts += client.event("output")["output"]
    client.ask("threads")
    assert [each for each in client.kept() if each.get("event") == "stopped"] == []
    assert "Error in PROG1 line 30: Divide by zero" in texts


def test_variables_arrays_and_axes_are_those_the_card_lists(
    client: Client, served: Served, card: Card
) -> None:
    for line in ("DIM LV(2)", "DIM SA(1)", "DIM SA0(120)", "DIM $V(1,20)", '$V0="AB"', "LV1=7"):
        card.command(line, program=2)
    card.command("SA0(1)=2.5", program=2)
    begin(client, served, "attach")
    scopes = client.ask("scopes", frameId=300)["scopes"]
    references = {each["name"]: each["variablesReference"] for each in scopes}
    assert list(references) == ["Variables", "Axes", "Program"]
    held = client.ask("variables", variablesReference=references["Variables"])["variables"]
    values = {each["name"]: each["value"] for each in held}
    assert values == {
        "LV0": "0", "LV1": "7", "$V0": "'AB'",
        "SA0": "120 elements, the first 100 of which are read",
    }  # fmt: skip
    array = next(each["variablesReference"] for each in held if each["name"] == "SA0")
    elements = client.ask("variables", variablesReference=array)["variables"]
    assert [(each["name"], each["value"]) for each in elements[:2]] == [
        ("SA0(0)", "0"), ("SA0(1)", "2.5"),
    ]  # fmt: skip
    assert len(elements) == 100
    axes = client.ask("variables", variablesReference=references["Axes"])["variables"]
    assert [(each["name"], each["value"]) for each in axes] == [("X (AXIS0)", "0")]
    changed = client.ask(
        "setVariable", variablesReference=references["Variables"], name="LV1", value="LV1+2"
    )
    assert (changed["value"], card.ask("LV1", program=2)) == ("9", 9)
    client.ask("setExpression", expression="BIT128", value="1", frameId=300)
    assert card.read_bit(128)
    client.ask("setExpression", expression="BIT128", value="0", frameId=300)
    assert not card.read_bit(128)


def test_what_a_card_over_a_link_cannot_do_is_refused_with_the_reason(
    client: Client, served: Served, card: Card
) -> None:
    card.run(0)
    begin(client, served, "attach")
    for command, arguments, text in (
        ("stepBack", {"threadId": 1}, "a card over a link has no past"),
        ("reverseContinue", {"threadId": 1}, "a card over a link has no past"),
        ("openacrSeek", {"tick": 1}, "a card over a link has no past"),
        ("openacrTimeline", {}, "a card over a link has no past"),
        ("stepOut", {"threadId": 1}, "steps line by line, not out of routines"),
        ("next", {"threadId": 1, "granularity": "instruction"}, "time of a card .* does not stop"),
        ("next", {"threadId": 2}, "PROG1 does not run"),
        ("next", {"threadId": 1}, "PROG0 is not held: pause it first"),
        ("continue", {"threadId": 1}, "PROG0 is not held: pause it first"),
        ("pause", {"threadId": 2}, "PROG1 does not run"),
        ("pause", {"threadId": 17}, "a PLC cannot be held"),
        ("scopes", {"frameId": 1700}, "there is no program 16"),
        ("source", {"sourceReference": 9}, "there is no listing 9"),
        ("evaluate", {"expression": "P0 : SET 128"}, "without a colon"),
        ("evaluate", {"expression": "LV9", "frameId": 100}, "Undefined variable"),
        ("setExpression", {"expression": "X", "value": "5"}, "what can be changed are variables"),
        ("setExpression", {"expression": "P0:X5 Y", "value": "5"}, "what can be changed"),
        ("setExpression", {"expression": "P0", "value": "5 : SET 128"}, "without a colon"),
    ):  # fmt: skip
        with pytest.raises(RefusedError, match=text):
            client.ask(command, **arguments)
    (data,) = client.ask("setDataBreakpoints", breakpoints=[{"dataId": "P0"}])["breakpoints"]
    assert not data["verified"]
    assert "P0: no value of a card" in data["message"]
    assert not card.read_bit(128)
    for source in ({"sourceReference": 1}, {"path": "/tmp/prog0.8k"}):
        found = client.ask("setBreakpoints", source=source, breakpoints=[{"line": 6}])
        assert found["breakpoints"] == [{
            "verified": False, "line": 6,
            "message": "a card over a link cannot stop before a line by itself: step, or write"
            " PAUSE into the program",
        }]  # fmt: skip
    found = client.ask("setBreakpoints", source={"sourceReference": 17}, breakpoints=[{"line": 1}])
    assert found["breakpoints"][0]["message"] == "a PLC has no lines to stop at"
    assert client.ask("dataBreakpointInfo", name="P0")["dataId"] is None


def test_a_launch_names_a_card_that_answers(client: Client, served: Served, card: Card) -> None:
    card.run(0)
    client.ask("initialize")
    for command, arguments, text in (
        ("launch", {"host": served.address, "program": "."}, "launch: give either"),
        ("launch", {"host": served.address, "stopOnEntry": True}, "name programs to `run`"),
        ("launch", {"host": "127.0.0.1:1"}, "127.0.0.1:1"),
        ("attach", {"program": "."}, "attach: give `host`"),
    ):
        with pytest.raises(RefusedError, match=text):
            client.ask(command, **arguments)
    client.ask("launch", host=served.address, run=[0], listen=[])
    with pytest.raises(RefusedError, match="PROG0 runs already: it is not started again"):
        client.ask("configurationDone")
    assert client.end() == 0
    assert is_running(card, 0)


def test_moves_of_typed_lines_end_with_the_session_and_those_of_others_go_on(
    client: Client, served: Served, card: Card
) -> None:
    card.command("DRIVE ON X", program=2)
    begin(client, served, "attach")
    answer = client.ask("evaluate", expression="?1+2", frameId=300, context="repl")
    assert answer["result"] == "3\n"
    client.ask("evaluate", expression="VEL 10 ACC 100 DEC 100", frameId=300, context="repl")
    client.ask("evaluate", expression="X/1000", frameId=300, context="repl")
    until(lambda: is_moving(card), "motion")
    client.ask("evaluate", expression="JOG VEL X5", frameId=300, context="repl")
    client.ask("evaluate", expression="JOG FWD X", frameId=300, context="repl")
    assert client.end() == 0
    assert not is_moving(card)
    until(lambda: not card.axis(0).is_jogging, "the jog has ended")


def test_a_program_that_others_run_goes_on_though_lines_were_typed_at_its_prompt(
    client: Client, served: Served, card: Card
) -> None:
    card.run(2)
    until(lambda: is_moving(card), "motion")
    begin(client, served, "attach")
    client.ask("evaluate", expression="P0=3", frameId=300, context="repl")
    assert client.end() == 0
    assert (is_running(card, 2), is_moving(card), card.read(0)) == (True, True, 3)


def test_moves_of_a_program_that_was_started_end_though_the_program_has_ended_before(
    client: Client, served: Served, card: Card
) -> None:
    begin(client, served, run=[4], listen=[0])
    assert client.event("output")["output"] == "PROG4 has ended\n"
    assert is_moving(card, 1)
    assert client.end() == 0
    assert not is_moving(card, 1)


@pytest.mark.skipif(sys.platform == "win32", reason="no signals of this kind")
def test_an_editor_that_terminates_the_debugger_at_its_end_does_not_keep_it_from_ending_all(
    client: Client, served: Served, card: Card
) -> None:
    begin(client, served, run=[2])
    until(lambda: is_moving(card), "motion")
    client.ask("pause", threadId=3)
    assert client.stop() == ("pause", 3)
    client.ask("next", threadId=3)
    client.ask("disconnect")
    for _ in range(2):
        client.process.send_signal(signal.SIGTERM)
    client.process.wait(LIMIT_S)
    assert flags(card, 2) & (HOLDS | pf.PROGRAM_RUNNING) == 0
    assert not is_moving(card)


@pytest.mark.parametrize("ending", ["closed", "terminated"])
def test_a_client_that_dies_leaves_nothing_moving_that_it_has_started(
    client: Client, served: Served, card: Card, ending: str
) -> None:
    card.run(0)
    begin(client, served, run=[2])
    until(lambda: is_moving(card), "motion")
    if ending == "closed":
        client.hang_up()
    elif sys.platform == "win32":
        pytest.skip("no signals of this kind")
    else:
        client.process.send_signal(signal.SIGTERM)
    client.process.wait(LIMIT_S)
    assert (is_running(card, 2), is_moving(card), is_running(card, 0)) == (False, False, True)


def test_a_program_held_in_a_move_is_ended_with_its_holds_and_its_move(
    client: Client, served: Served, card: Card
) -> None:
    begin(client, served, run=[2])
    until(lambda: is_moving(card), "motion")
    client.ask("pause", threadId=3)
    assert client.stop() == ("pause", 3)
    assert flags(card, 2) & pf.PAUSE_MODE
    client.hang_up()
    client.process.wait(LIMIT_S)
    assert flags(card, 2) & (HOLDS | pf.PROGRAM_RUNNING) == 0
    assert not is_moving(card)


def test_a_broken_line_is_a_stop_and_another_one_serves_to_end_what_was_started(
    client: Client, served: Served, card: Card
) -> None:
    with Relay(served.address) as relay:
        client.ask("initialize", adapterID="openacr")
        client.ask("launch", host=relay.address, run=[2], listen=[0])
        client.ask("configurationDone")
        until(lambda: is_moving(card), "motion")
        relay.cut()
        assert client.stop()[0] == "exception"
        assert (is_running(card, 2), is_moving(card)) == (True, True)
        assert client.end() == 0
    assert (is_running(card, 2), is_moving(card)) == (False, False)


@pytest.mark.skipif(sys.platform == "win32", reason="no signals of this kind")
def test_a_card_that_answers_no_more_is_a_stop(client: Client, served: Served, card: Card) -> None:
    begin(client, served, run=[0], listen=[1])
    served.process.send_signal(signal.SIGSTOP)
    text = client.event("stopped")["text"]
    served.process.send_signal(signal.SIGCONT)
    assert "no reply within" in text
    assert client.end() == 0
    assert not is_running(card, 0)


def test_a_card_that_dies_is_a_stop_and_ends_nothing_else(client: Client, served: Served) -> None:
    begin(client, served, run=[0])
    served.kill()
    body = client.event("stopped")
    assert (body["reason"], body["text"].partition(":")[0]) == ("exception", "the card is lost")
    with pytest.raises(RefusedError, match=r"the card is lost: .*; what it does now is not known"):
        client.value("P0")
    with pytest.raises(RefusedError, match="the card is lost"):
        client.ask("next", threadId=1)
    assert client.end() == 0


def test_what_an_editor_does_not_take_waits_on_the_card_and_nothing_is_lost(
    card: Card, served: Served, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(followers, "MOST_HEARD", 2)
    lines = ["INH 34", "P9=0", "_NEXT", "P9=P9+1", "PRINT P9", "IF (P9<500) THEN GOTO NEXT"]
    card.download("\n".join(["PROGRAM", *lines, "ENDP", ""]), to=Level.program(5))
    listeners, text = followers.Followers(served.address), ""
    try:
        listeners.follow(5)
        card.run(5)
        card.write_bit(34, True)
        until(lambda: float(card.read(9)) == 500, "the program has printed all")
        assert listeners._heard.qsize() <= 2

        def is_heard() -> bool:
            nonlocal text
            text += "".join(each.text for each in listeners.heard())
            return text.split()[-1:] == ["500"]

        until(is_heard, "all is heard")
    finally:
        listeners.close()
    assert text.split() == [str(number) for number in range(1, 501)]
