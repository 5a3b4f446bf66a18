"""Programs and PLCs of the card at the screens: states, listings, ladders, commands."""

from collections.abc import Iterator
from typing import Any

import httpx
import pytest
from tests.panel.bench import LIMIT_S, HandStation, Served

from openacr.client import Card, ConnectionLostError, Level
from openacr.client.stored import listing, rooms
from openacr.errors import UserError
from openacr.panel.control.engineer.card_programs import read_states
from openacr.panel.control.operator.people import Person
from openacr.panel.control.station import Station
from openacr.panel.roles import Role

COUNTING = "PROGRAM\nDIM LV(1)\n_more\nLV0 = LV0+1\nDWL 0.05\nPRINT LV0\nGOTO more\nENDP\n"


def names(hand: HandStation) -> dict[str, dict[str, Any]]:
    return {each["name"]: each for each in hand.events("programs")[-1]["programs"]}


@pytest.fixture
def watching(hand: HandStation) -> HandStation:
    hand.do("watch.begin", topic="programs", hz=10)
    hand.run(0.2)
    return hand


def sent(hand: HandStation, text: str = COUNTING, **which: int) -> None:
    hand.do("card.send", text=text, **(which or {"program": 3}))


def test_a_running_program_shows_its_state_and_its_line(watching: HandStation) -> None:
    hand = watching
    assert names(hand)["PROG3"] == {"name": "PROG3", "state": "halted", "line": 0, "block": False}
    assert names(hand)["PROG7"]["state"] in ("running", "dwells")  # the watchdog
    assert len(names(hand)) == 24
    sent(hand)
    hand.do("card.run", program=3)
    hand.until(lambda: names(hand)["PROG3"]["state"] == "dwells")
    assert names(hand)["PROG3"]["line"] == 50
    hand.do("card.pause", program=3)
    hand.until(lambda: names(hand)["PROG3"]["state"] == "paused")
    hand.do("card.resume", program=3)
    hand.until(lambda: names(hand)["PROG3"]["state"] == "dwells")
    hand.do("card.block", program=3, on=True)
    hand.until(lambda: names(hand)["PROG3"]["state"] == "waits for STEP")
    line = names(hand)["PROG3"]["line"]
    hand.do("card.step", program=3)
    hand.until(lambda: names(hand)["PROG3"]["line"] != line)
    assert names(hand)["PROG3"]["block"]
    hand.do("card.block", program=3, on=False)
    hand.until(lambda: not names(hand)["PROG3"]["block"])
    hand.do("card.halt", program=3)
    hand.until(lambda: names(hand)["PROG3"]["state"] == "halted")
    assert names(hand)["PROG3"]["line"] == 0


def test_a_state_is_sent_when_it_changes_and_at_most_as_often_as_asked_for(
    watching: HandStation,
) -> None:
    hand = watching
    count = len(hand.events("programs"))
    hand.run(1.0)
    news = hand.events("programs")[count:]
    assert len(news) <= 10  # the watchdog changes its line all the time
    assert all(each["to"] == 1 for each in news)


def test_the_card_is_asked_only_while_a_screen_watches(
    hand: HandStation, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[int] = []
    card = hand.station.times.history
    read_rows = card.read_rows

    def counted(parameters: list[int]) -> list[float]:
        if 7168 in parameters:
            asked.append(1)
        return read_rows(parameters)

    monkeypatch.setattr(card, "read_rows", counted)
    hand.run(0.5)
    assert asked == []
    hand.do("watch.begin", topic="programs", hz=60)
    hand.run(1.0)
    assert 5 <= len(asked) <= 12  # 10 a second at most, and one for the sizes of texts
    hand.do("watch.end", topic="programs")
    asked.clear()
    hand.run(0.5)
    assert asked == []
    hand.do("watch.begin", topic="programs", hz=10)
    hand.station.leave(1)
    hand.run(0.5)
    assert asked == []


# --- texts ----------------------------------------------------------------------------


def listed(hand: HandStation, level: Level) -> list[tuple[int, str]]:
    future = hand.station.on_card.aside.begin(lambda talk: listing(talk, level))
    hand.until(future.done)
    return [(line.number, line.text) for line in future.result()]


@pytest.mark.req("MILL-PLC-EDIT")
def test_an_edited_program_and_an_edited_plc_run_with_the_new_text(hand: HandStation) -> None:
    sent(hand)
    sent(hand, COUNTING.replace("LV0+1", "LV0+1 : SET 130"))
    assert (40, " LV0 = LV0+1 : SET 130") in listed(hand, Level.program(3))
    card = hand.station.link.machine.card
    assert not card.read_bit(130)
    hand.do("card.run", program=3)
    hand.until(lambda: card.read_bit(130))
    card.go(Level())
    card.command("DIM PLC0(2000)")
    sent(hand, "10 LD 128\n20 OUT 129\n", plc=0)
    hand.do("card.run", plc=0)
    card.write_bit(128, True)
    hand.until(lambda: card.read_bit(129))
    hand.do("card.halt", plc=0)
    sent(hand, "10 LD 128\n20 OUT NOT 129\n", plc=0)
    assert listed(hand, Level.plc(0)) == [(10, "LD 128"), (20, "OUT NOT 129")]
    hand.do("card.run", plc=0)
    hand.until(lambda: not card.read_bit(129))


def test_a_text_that_the_card_refuses_leaves_the_former_one(hand: HandStation) -> None:
    sent(hand, "10 P0 = 1\n20 END\n")
    error = hand.refused("card.send", program=3, text="10 P0 = 2\n20 NOWORD 5\n")
    assert error["text"] == "2: Unknown command (PROG3 has its former text)"
    assert listed(hand, Level.program(3)) == [(10, "P0 = 1"), (20, "END")]
    error = hand.refused("card.send", program=4, text="PROGRAM\nP0 = 2 +\nENDP\n")
    assert error["text"] == "2: Syntax error (PROG4 is empty, as before)"
    assert listed(hand, Level.program(4)) == []
    sent(hand)
    before = listed(hand, Level.program(3))
    hand.refused("card.send", program=3, text="PROGRAM\nP0 = 2\nNOWORD 5\nENDP\n")
    assert listed(hand, Level.program(3)) == before


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("", "the text is empty: CLEAR erases a program"),
        ("SYS\nNEW ALL\n", "line 1: every line has a number, or the text stands between"),
        ("10 P0 = 1\nHALT ALL\n", "line 2: every line has a number"),
        ("PROGRAM\nP0 = 1\nSYS\nCLEAR\nENDP\n", "line 3: SYS would end the program"),
        ("PROGRAM\nP0 = 1\n: PROG4\nENDP\n", "line 3: : would end the program"),
        ("PROGRAM\nENDP\nNEW ALL\nENDP\n", "line 2: ENDP would end the program"),
        ("PROGRAM\nP0 = 1\n", "line 2: a text that begins with PROGRAM ends with ENDP"),
    ],
)
def test_a_line_that_would_be_carried_out_is_not_sent(
    hand: HandStation, text: str, why: str
) -> None:
    error = hand.refused("card.send", program=3, text=text)
    assert error["text"].startswith(why)


def test_a_shorter_text_leaves_nothing_of_the_longer_one(hand: HandStation) -> None:
    sent(hand, "10 P0 = 1\n20 P1 = 1\n30 END\n")
    sent(hand, "10 P0 = 2\n20 END\n")
    assert listed(hand, Level.program(3)) == [(10, "P0 = 2"), (20, "END")]
    sent(hand)
    sent(hand, "15 P0 = 3\n")
    assert listed(hand, Level.program(3)) == [(15, "P0 = 3")]


def test_clear_erases_the_lines(hand: HandStation) -> None:
    sent(hand)
    hand.do("card.clear", program=3)
    assert listed(hand, Level.program(3)) == []


# --- who, and when --------------------------------------------------------------------

CHANGES = ("run", "halt", "pause", "resume", "step", "block", "clear")


@pytest.mark.parametrize("word", CHANGES)
def test_commands_to_programs_need_the_role_service_and_control(
    hand: HandStation, word: str
) -> None:
    other = Person(2, Role.SETUP, "10.0.0.2")
    hand.station.join(other)
    answer = hand.send(f"card.{word}", who=other, program=3)
    assert answer["error"]["needs"] == "service"
    hand.do("control.take")
    second = Person(3, Role.SERVICE, "10.0.0.3")
    hand.station.join(second)
    assert hand.send(f"card.{word}", who=second, program=3)["error"]["code"] == "control"


@pytest.mark.parametrize("word", CHANGES)
def test_the_watchdog_of_this_machine_is_not_touched(hand: HandStation, word: str) -> None:
    error = hand.refused(f"card.{word}", program=7)
    assert error["text"] == "PROG7 of the card belongs to this machine"


@pytest.mark.parametrize("word", CHANGES)
def test_the_program_of_the_axes_is_not_touched_while_the_machine_uses_it(
    hand: HandStation, word: str
) -> None:
    hand.do("mdi.execute", line="G21 G91 G1 X50 F600")
    hand.run(0.2)
    assert hand.refused(f"card.{word}", program=0)["text"] == (
        "PROG0 of the card is used by this machine now (state RUN): ABORT, or wait until it has"
        " ended"
    )
    assert hand.is_busy


MAIN = "PROGRAM\n_again\nX1\nX0\nGOTO again\nENDP\n"


def test_the_main_program_is_an_ordinary_one_until_acromill_is_set_up_again(
    hand: HandStation,
) -> None:
    sent(hand, MAIN, program=0)
    lacks = "PROG0 is an ordinary program of the card now"
    hand.run(0.1)
    assert hand.events("machine")[-1]["lacks"] == lacks
    assert hand.refused("home.start", axes="X")["text"] == lacks
    for word, does in (
        ("run", "running"),
        ("pause", "paused"),
        ("resume", "running"),
        ("halt", "halted"),
    ):
        hand.do(f"card.{word}", program=0)
        hand.run(0.3)
        state = hand.do("card.query", line="?P0") and states_now(hand)["PROG0"]
        assert state.startswith(does) or (does, state) == ("running", "waits for room"), word
    hand.do("card.clear", program=0)
    hand.do("card.setup")
    hand.run(0.1)
    assert hand.events("machine")[-1]["lacks"] == ""
    hand.do("mdi.execute", line="G21 G91 G1 X1 F600")
    hand.until(lambda: not hand.is_busy)


def states_now(hand: HandStation) -> dict[str, str]:
    return {each["name"]: each["state"] for each in read_states(hand.station.link.read)}


@pytest.mark.parametrize(
    ("name", "args"),
    [
        ("home.start", {"axes": "X"}),
        ("mdi.execute", {"line": "G21 G91 G1 X1 F600"}),
        ("jog.increment", {"axis": "X", "direction": 1, "distance": 1.0}),
    ],
)
def test_the_machine_is_not_moved_while_the_program_of_its_axes_runs(
    hand: HandStation, name: str, args: dict[str, Any]
) -> None:
    controller = hand.installation.controller
    assert controller is not None
    with Card.open(controller) as other:
        for line in ("PROGRAM", "_wait", "DWL 1", "GOTO wait", "ENDP"):
            other.command(line, program=0)
        other.run(0)
    hand.run(0.1)
    more = {"tick": hand.tick} if name == "jog.increment" else {}
    assert hand.refused(name, **args, **more)["text"] == (
        "PROG0 runs on the card, and the machine needs its axes: halt it first (HALT PROG0)"
    )


@pytest.mark.parametrize(("line", "is_taken"), [("ATTACH MASTER1", True), ("P0=1", False)])
def test_a_file_that_attaches_axes_takes_them_from_the_machine(
    hand: HandStation, line: str, is_taken: bool
) -> None:
    mark = hand.station.on_card.parked.put(f"PROG1\n{line}\n")
    hand.do("card.download", parked=mark)
    assert bool(hand.installation.lacks) is is_taken


def test_a_command_names_one_program_or_one_plc(hand: HandStation) -> None:
    for args in ({}, {"program": 3, "plc": 0}):
        assert hand.refused("card.run", **args)["text"] == "name a program or a PLC"


def test_nothing_is_started_or_changed_while_the_machine_moves(hand: HandStation) -> None:
    sent(hand)
    hand.do("mdi.execute", line="G21 G91 G1 X50 F600")
    hand.run(0.2)
    for word in ("run", "resume", "step"):
        error = hand.refused(f"card.{word}", program=3)
        assert error["text"] == "the machine moves: no program of the card is started"
    assert "machine moves" in hand.refused("card.block", program=3, on=False)["text"]
    assert "machine moves" in hand.refused("card.run", plc=0)["text"]
    for word, more in (("send", {"text": COUNTING}), ("clear", {})):
        error = hand.refused(f"card.{word}", program=3, **more)
        assert error["text"] == "the machine moves: no program of the card is changed"
    hand.do("card.halt", program=3)  # what ends motion is always taken
    hand.do("card.pause", program=3)
    hand.do("stop.all")


def test_a_held_key_bars_a_start(hand: HandStation) -> None:
    assert hand.press(1)["ok"]
    hand.run(0.05)
    assert "machine moves" in hand.refused("card.run", program=3)["text"]


def test_a_program_is_not_started_while_an_alarm_is_active_but_a_plc_is(hand: HandStation) -> None:
    card = hand.station.link.machine.card
    card.go(Level())
    card.command("DIM PLC0(2000)")
    sent(hand, "10 LD 128\n20 OUT 129\n", plc=0)
    sent(hand)
    hand.do("stop.estop")
    hand.run(0.2)
    assert hand.events("alarms")[-1]["bars_start"]
    assert not hand.send("card.run", program=3)["ok"]
    hand.do("card.run", plc=0)


def test_a_running_program_is_not_changed(hand: HandStation) -> None:
    sent(hand)
    hand.do("card.run", program=3)
    for word, more in (("send", {"text": COUNTING}), ("clear", {})):
        assert (
            hand.refused(f"card.{word}", program=3, **more)["text"] == "PROG3 runs: halt it first"
        )


# --- stops ----------------------------------------------------------------------------


def test_stop_pauses_all_programs_of_the_card_but_the_watchdog(watching: HandStation) -> None:
    hand = watching
    sent(hand)
    sent(hand, program=4)
    hand.station.link.machine.card.command("RUN PROG4")  # not by a screen
    hand.do("card.run", program=3)
    hand.run(0.2)
    hand.do("stop.hold")
    hand.until(lambda: names(hand)["PROG3"]["state"] == "paused")
    hand.until(lambda: names(hand)["PROG4"]["state"] == "paused")
    assert names(hand)["PROG7"]["state"] in ("running", "dwells")  # the watchdog
    hand.do("run.resume")
    hand.until(lambda: names(hand)["PROG3"]["state"] == "dwells")
    hand.until(lambda: names(hand)["PROG4"]["state"] == "dwells")
    for stop in ("stop.all", "stop.estop"):
        hand.do(stop)
        hand.until(lambda: names(hand)["PROG3"]["state"] == "halted")
        if stop == "stop.all":
            hand.do("card.run", program=3)
            hand.until(lambda: names(hand)["PROG3"]["state"] == "dwells")


def test_a_plc_goes_on_through_every_stop(watching: HandStation) -> None:
    hand = watching
    card = hand.station.link.machine.card
    card.go(Level())
    card.command("DIM PLC0(2000)")
    sent(hand, "10 LD 128\n20 OUT 129\n", plc=0)
    hand.do("card.run", plc=0)
    hand.until(lambda: names(hand)["PLC0"]["state"] == "running")
    for stop in ("stop.hold", "stop.all", "stop.estop"):
        hand.do(stop)
        hand.run(0.3)
        assert names(hand)["PLC0"]["state"] == "running"


# --- listening ------------------------------------------------------------------------


def test_what_a_program_prints_is_shown_to_those_who_listen(hand: HandStation) -> None:
    sent(hand)
    hand.do("card.run", program=3)
    viewer = Person(2, Role.VIEW, "10.0.0.2")
    hand.station.join(viewer)
    assert hand.send("card.listen", who=viewer, program=3)["ok"]

    def heard(client: int) -> str:
        return "".join(e["text"] for e in hand.events("listen") if e["to"] == client)

    hand.until(lambda: heard(2).count("\n") >= 3)
    numbers = [int(each) for each in heard(2).split()]
    assert numbers == list(range(numbers[0], numbers[0] + len(numbers)))
    hand.do("card.listen", program=3)
    hand.until(lambda: heard(1).count("\n") >= 3)
    error = hand.refused("card.listen", program=4)
    assert error["text"] == "PROG3 is listened to on another screen"
    hand.station.leave(2)
    hand.do("card.listen", program=4)
    hand.run(0.3)
    count = len(hand.events("listen"))
    hand.run(0.3)
    assert len(hand.events("listen")) == count
    hand.do("card.unlisten", program=4)
    assert not hand.station.on_card.listening._aside.is_busy


def test_a_lost_card_ends_what_is_under_way(hand: HandStation) -> None:
    future = hand.station.on_card.aside.begin(lambda talk: listing(talk, Level.program(7)))
    other = hand.station.on_card.aside.begin(rooms)
    hand.station.on_card.aside.step(hand.now_s)
    assert not future.done()
    hand.station.on_card.end()
    for each in (future, other):
        assert isinstance(each.exception(), ConnectionLostError)


def test_no_more_than_twenty_listings_wait(hand: HandStation) -> None:
    for _ in range(20):
        hand.station.on_card.aside.begin(rooms)
    with pytest.raises(UserError, match="too many listings"):
        hand.station.on_card.aside.begin(rooms)


# --- calls ----------------------------------------------------------------------------


@pytest.fixture
def web(panel: Served) -> Iterator[httpx.Client]:
    with httpx.Client(base_url=panel.url, timeout=LIMIT_S) as client:
        yield client


def by_session(panel: Served, *lines: str, text: str = "", level: Level | None = None) -> None:
    """Type lines at the card of a panel, and store a text."""

    def do(station: Station) -> None:
        card = station.link.machine.card
        card.go(Level())
        for line in lines:
            card.command(line)
        if text:
            card.download(text, to=level)

    panel.call(do)


def test_the_list_has_states_memory_and_owners(panel: Served, web: httpx.Client) -> None:
    by_session(panel, "DIM PLC2(1000)", text="10 LD 1 OUT 130\n", level=Level.plc(2))
    found = {each["name"]: each for each in web.get("/api/card/programs").json()["programs"]}
    assert len(found) == 24
    assert found["PLC2"] == {
        "name": "PLC2", "state": "halted", "bytes": 1000, "used": 16, "owner": "",
    }  # fmt: skip
    assert found["PLC3"] == {
        "name": "PLC3", "state": "halted", "bytes": 0, "used": 0, "owner": "",
    }  # fmt: skip
    assert found["PROG7"]["owner"] == "PROG7 of the card belongs to this machine"
    assert (found["PROG7"]["bytes"], found["PROG3"]["owner"]) == (65536, "")
    assert found["PROG7"]["used"] > 500


def test_a_listing_has_the_numbers_that_the_running_line_has(
    panel: Served, web: httpx.Client
) -> None:
    by_session(panel, text=COUNTING, level=Level.program(3))
    lines = web.get("/api/card/listing", params={"program": 3}).json()["lines"]
    assert lines[0] == {"number": 10, "text": "PROGRAM"}
    assert lines[4] == {"number": 50, "text": " DWL 0.05"}
    watchdog = web.get("/api/card/listing", params={"program": 7}).json()
    assert watchdog["name"] == "PROG7"
    assert watchdog["lines"][0] == {"number": 10, "text": "REM openacr watchdog"}
    assert web.get("/api/card/listing", params={"plc": 1}).json()["lines"] == []
    refused = web.get("/api/card/listing")
    assert (refused.status_code, refused.json()["error"]["text"]) == (
        422,
        "name a program or a PLC",
    )
    assert web.get("/api/card/listing", params={"program": 16}).status_code == 400


def test_a_plc_comes_as_a_ladder_or_with_the_reason_why_not(
    panel: Served, web: httpx.Client
) -> None:
    by_session(
        panel, "DIM PLC0(1000)", text="10 LD 0\n20 AND NOT 1\n30 OUT 40\n", level=Level.plc(0)
    )
    found = web.get("/api/card/ladder", params={"plc": 0}).json()
    assert (found["name"], found["why"], len(found["lines"])) == ("PLC0", "", 3)
    (rung,) = found["rungs"]
    assert (rung["line"], rung["columns"], rung["rows"], rung["nets"]) == (10, 3, 1, 4)
    assert rung["symbols"][1] == {
        "kind": "contact", "text": "1", "flag": 1, "is_negated": True, "number": None,
        "column": 1, "row": 0, "source": 1, "sink": 2, "reset": None, "reset_row": None,
    }  # fmt: skip
    by_session(panel, "NEW PLC0", text="10 AND 5\n", level=Level.plc(0))
    found = web.get("/api/card/ladder", params={"plc": 0}).json()
    assert (found["rungs"], found["why"]) == ([], "PLC error line 10: LD expected")
    by_session(
        panel,
        "DIM DEF(10)",
        "#DEFINE door BIT5",
        "NEW PLC0",
        text="10 LD door\n20 OUT 40\n",
        level=Level.plc(0),
    )
    found = web.get("/api/card/ladder", params={"plc": 0}).json()
    (rung,) = found["rungs"]
    assert [(each["text"], each["flag"]) for each in rung["symbols"]] == [("door", 5), ("40", 40)]
    assert (found["why"], found["names"]) == ("", {"5": "door"})
    by_session(panel, "#DEFINE speed P 12290", "#DEFINE many 7", "#DEFINE gate BIT5")
    named = {"P12290": "speed", "BIT5": "gate"}
    assert web.get("/api/card/aliases").json() == {"aliases": named}
    assert found["lines"][0] == {"number": 10, "text": "LD door"}


def test_the_calls_and_commands_are_described(web: httpx.Client) -> None:
    document = web.get("/api/openapi.json").json()
    assert {"/api/card/programs", "/api/card/listing", "/api/card/ladder"} <= set(document["paths"])
    commands = document["x-commands"]
    assert {f"card.{word}" for word in (*CHANGES, "send", "listen", "unlisten")} <= set(commands)
    assert commands["card.listen"]["role"] == "view"
    assert "Nothing is run" in commands["card.send"].pop("description")
    assert commands["card.send"] == {
        "summary": "Store a text as a program or PLC of the card, verified; refused, the old one"
        " stays.",
        "role": "service", "needs_control": True,
        "args": {"$ref": "#/components/schemas/CardSend"},
    }  # fmt: skip
