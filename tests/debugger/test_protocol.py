"""The debugger as editors use it: a process that speaks the protocol."""

import re
import socket
import subprocess
from io import BytesIO
from pathlib import Path
from typing import IO, cast

import pytest
from tests import warm
from tests.debugger.client import LIMIT_S, Client, RefusedError
from tests.debugger.project import card_of, write

from openacr.controller import Controller
from openacr.controller.recorder import Recorder
from openacr.debugger.server import serve
from openacr.debugger.wire import BrokenStreamError, read_message, write_message
from openacr.plant.describe.load import parse_world

LAMP = """\
from typing import ClassVar
from openacr.plant.devices.device import Device

class Lamp(Device):
    SIGNALS: ClassVar = {"lit": bool}
    def step(self, dt_s, commands):
        return {"lit": True}
"""


@pytest.fixture
def begun(client: Client, tmp_path: Path) -> Client:
    """At the beginning, with program 0 started."""
    client.launch(write(tmp_path), run=[0])
    client.ask("configurationDone")
    assert client.stop() == ("entry", 1)
    return client


def test_a_session_from_its_beginning_to_its_end(begun: Client, tmp_path: Path) -> None:
    source = {"path": str(tmp_path / "prog0.8k")}
    found = begun.ask("setBreakpoints", source=source, breakpoints=[{"line": 10}, {"line": 99}])
    assert [each["verified"] for each in found["breakpoints"]] == [True, False]
    names = [each["name"] for each in begun.ask("threads")["threads"]]
    assert names == ["PROG0", "PROG1", "PLC0"]
    begun.ask("continue", threadId=1)
    assert begun.stop() == ("breakpoint", 1)
    frames = begun.ask("stackTrace", threadId=1)["stackFrames"]
    assert [frame["line"] for frame in frames] == [10, 6]
    assert (begun.value("P0"), begun.value("P1")) == ("3", "0")
    begun.ask("next", threadId=1)
    assert begun.stop() == ("step", 1)
    assert (begun.place(1), begun.value("P1")) == (("prog0.8k", 11), "6")
    begun.ask("stepBack", threadId=1)
    assert begun.stop() == ("step", 1)
    assert (begun.place(1), begun.value("P1")) == (("prog0.8k", 10), "0")
    begun.ask("stepOut", threadId=1)
    assert begun.stop() == ("step", 1)
    assert begun.place(1) == ("prog0.8k", 7)
    begun.ask("reverseContinue", threadId=1)
    assert begun.stop() == ("breakpoint", 1)
    begun.ask("reverseContinue", threadId=1)
    assert begun.stop() == ("entry", 1)
    assert begun.end() == 0


def test_one_breakpoint_that_cannot_be_leaves_the_others(begun: Client, tmp_path: Path) -> None:
    source = {"path": str(tmp_path / "prog0.8k")}
    wanted = [{"line": 5, "hitCondition": "x"}, {"line": 6}, {"line": 7, "hitCondition": "\u00b2"}]
    found = begun.ask("setBreakpoints", source=source, breakpoints=wanted)["breakpoints"]
    assert [each["verified"] for each in found] == [False, True, False]
    assert found[0]["message"] == "x: the count of hits is a number from 1 on"
    data = [{"dataId": "Q1"}, {"dataId": "P1"}]
    found = begun.ask("setDataBreakpoints", breakpoints=data)["breakpoints"]
    assert [each["verified"] for each in found] == [False, True]
    assert found[0]["message"].startswith("Q1: a value to be watched is a parameter")
    begun.ask("continue", threadId=1)
    assert (begun.stop(), begun.place(1)) == (("breakpoint", 1), ("prog0.8k", 6))
    begun.ask("setBreakpoints", source=source, breakpoints=[])
    begun.ask("continue", threadId=1)
    assert (begun.stop()[0], begun.value("P1")) == ("data breakpoint", "6")
    assert begun.end() == 0


def test_labels_and_remarks_alone_are_no_lines_to_stop_at(begun: Client, tmp_path: Path) -> None:
    source = {"path": str(tmp_path / "prog0.8k")}
    every = [{"line": line} for line in range(1, 15)]
    found = begun.ask("setBreakpoints", source=source, breakpoints=every)["breakpoints"]
    refused = {each["line"]: each["message"] for each in found if not each["verified"]}
    assert refused == dict.fromkeys((2, 4, 9), "nothing is executed here")
    places = begun.ask("breakpointLocations", source=source, line=1, endLine=14)["breakpoints"]
    met = set()
    for _ in range(26):
        begun.ask("continue", threadId=1)
        assert begun.stop() == ("breakpoint", 1)
        met.add(begun.place(1)[1])
    assert [each["line"] for each in places] == sorted(met | {14})
    assert begun.end() == 0


def test_a_line_of_a_plc_stops_where_its_coil_changes(begun: Client, tmp_path: Path) -> None:
    source = {"path": str(tmp_path / "plc0.8k")}
    found = begun.ask("setBreakpoints", source=source, breakpoints=[{"line": 1}, {"line": 2}])
    assert [each["verified"] for each in found["breakpoints"]] == [False, True]
    assert "no coil of a PLC on this line" in found["breakpoints"][0]["message"]
    places = begun.ask("breakpointLocations", source=source, line=1, endLine=2)
    assert places == {"breakpoints": [{"line": 2}]}
    begun.ask("evaluate", expression="RUN PLC0", context="repl")
    begun.ask("evaluate", expression="SET 40", context="repl")
    begun.ask("continue", threadId=1)
    stop = begun.event("stopped")
    assert (stop["reason"], stop["threadId"], stop["text"]) == ("breakpoint", 17, "BIT41 is set")
    assert begun.place(17) == ("plc0.8k", 2)
    (frame,) = begun.ask("stackTrace", threadId=17)["stackFrames"]
    scopes = begun.ask("scopes", frameId=frame["id"])["scopes"]
    assert [each["name"] for each in scopes] == ["Rung", "Time"]
    begun.ask("next", threadId=17)
    assert begun.stop()[0] == "step"
    assert begun.ask("stackTrace", threadId=17)["stackFrames"] == []
    assert begun.end() == 0


def test_a_wrong_request_is_answered_with_a_sentence_and_ends_nothing(begun: Client) -> None:
    for command, arguments, text in (
        ("fly", {}, "fly: this debugger has no such request"),
        ("stackTrace", {}, "missing required field `threadId`"),
        ("stackTrace", {"threadId": 99}, "threadId is 99; it must be a whole number from 1 to 24"),
        ("variables", {"variablesReference": 77}, "these values are of an earlier stop"),
        ("next", {"threadId": 2}, "PROG1 does not run"),
        ("evaluate", {"expression": "LV9"}, r"\?LV9: Undefined variable"),
        ("evaluate", {"expression": "P0\r\nNEW"}, "cannot be typed"),
        ("source", {"sourceReference": 9}, "there is no listing 9"),
        ("openacrSeek", {"tick": 10**9}, "tick 1000000000 is not on branch 0"),
    ):
        with pytest.raises(RefusedError, match=text):
            begun.ask(command, **arguments)
    assert begun.value("1+1") == "2"
    assert begun.end() == 0


def test_a_client_that_is_gone_ends_the_debugger(begun: Client) -> None:
    begun.ask("continue", threadId=1)
    begun.close()
    assert begun.process.returncode is not None


def test_a_closed_stream_ends_the_debugger(begun: Client) -> None:
    assert begun.process.stdin is not None
    begun.process.stdin.close()
    assert begun.process.wait(LIMIT_S) == 0


def test_values_are_shown_in_groups_and_can_be_changed(begun: Client, tmp_path: Path) -> None:
    source = {"path": str(tmp_path / "prog0.8k")}
    begun.ask("setBreakpoints", source=source, breakpoints=[{"line": 5, "condition": "P0=2"}])
    begun.ask("continue")
    assert begun.stop() == ("breakpoint", 1)
    scopes = {
        each["name"]: each["variablesReference"]
        for each in begun.ask("scopes", frameId=100)["scopes"]
    }
    assert list(scopes) == ["Variables", "Program", "Time"]
    found = begun.ask("variables", variablesReference=scopes["Variables"], start=1, count=1)
    assert [(each["name"], each["value"]) for each in found["variables"]] == [("LV1", "0")]
    arguments = {"variablesReference": scopes["Variables"], "value": "3*4"}
    assert begun.ask("setVariable", name="LV1", **arguments) == {"value": "12"}
    with pytest.raises(RefusedError, match="LV9 is not one of these values"):
        begun.ask("setVariable", name="LV9", **arguments)
    assert begun.ask("setExpression", expression="BIT130", value="1", frameId=100) == {
        "value": "-1"
    }
    assert begun.ask("evaluate", expression="?P0;BIT130", context="repl", frameId=100)[
        "result"
    ] == ("2-1\nP00>")
    assert begun.end() == 0


def test_a_running_card_can_be_paused_and_prints(begun: Client) -> None:
    begun.ask("evaluate", expression="PROG2", context="repl")
    begun.ask("evaluate", expression='10 PRINT "hello"', context="repl", frameId=300)
    begun.ask("evaluate", expression="RUN", context="repl", frameId=300)
    begun.ask("continue")
    assert begun.event("output") == {"category": "stdout", "output": "hello\r\n"}
    with pytest.raises(RefusedError, match="the card runs: pause it first"):
        begun.ask("scopes", frameId=100)
    begun.ask("pause", threadId=1)
    assert begun.stop() == ("pause", 1)
    assert begun.end() == 0


def test_data_faults_and_texts_are_protocol_too(begun: Client, tmp_path: Path) -> None:
    info = begun.ask("dataBreakpointInfo", name="p5")
    assert (info["dataId"], info["description"]) == ("P5", "P5 changes")
    assert begun.ask("dataBreakpointInfo", name="LV0")["dataId"] is None
    begun.ask("setDataBreakpoints", breakpoints=[{"dataId": "P5"}])
    begun.ask("setExceptionBreakpoints", filters=["program-error"])
    begun.ask("evaluate", expression="RUN", context="repl", frameId=200)
    begun.ask("continue")
    assert begun.event("stopped")["text"] == "P5 has changed"
    begun.ask("continue")
    assert begun.stop() == ("exception", 2)
    assert begun.ask("exceptionInfo", threadId=2)["description"] == "Divide by zero"
    listing = begun.ask("source", sourceReference=17)["content"]
    assert listing == "10 LD 40\n20 OUT 41\n"
    found = begun.ask(
        "breakpointLocations", source={"path": str(tmp_path / "prog1.8k")}, line=2, endLine=9
    )
    assert found == {"breakpoints": [{"line": line} for line in (2, 3, 4, 5)]}
    found = begun.ask("setBreakpoints", source={"sourceReference": 17}, breakpoints=[{"line": 1}])
    assert "no coil of a PLC" in found["breakpoints"][0]["message"]
    assert begun.end() == 0


def test_the_past_has_branches(begun: Client) -> None:
    begun.ask("next", threadId=1, granularity="instruction")
    begun.stop()
    tick = begun.ask("openacrTimeline")["tick"]
    begun.ask("openacrSeek", tick=tick - 1)
    assert begun.stop()[0] == "goto"
    begun.ask("setExpression", expression="P9", value="1")
    found = begun.ask("openacrTimeline")
    assert [each["parent"] for each in found["branches"]] == [None, 0]
    begun.ask("openacrSeek", tick=tick, branch=0)
    assert begun.stop()[0] == "goto"
    assert begun.value("P9") == "0"
    assert begun.end() == 0


def test_a_journal_is_debugged_after_the_fact(client: Client, tmp_path: Path) -> None:
    card = card_of(tmp_path)
    card.recorder = Recorder(card, tmp_path / "a.journal")
    card.send("PROG0\rRUN\r")
    card.advance(500)
    card.p[0] = 100
    card.advance(500)
    card.close()
    client.launch(tmp_path, program="", journal=str(tmp_path / "a.journal"))
    client.ask("configurationDone")
    client.stop()
    client.ask("setDataBreakpoints", breakpoints=[{"dataId": "P1", "condition": "P1>=200"}])
    client.ask("continue")
    assert client.stop()[0] == "data breakpoint"
    assert client.value("P0") == "101"
    client.ask("stepBack", threadId=1)
    client.stop()
    frame = client.ask("stackTrace", threadId=1)["stackFrames"][0]
    assert (frame["name"], frame["source"]["sourceReference"]) == ("PROG0 line 70", 1)
    assert client.end() == 0


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        ({"program": ""}, "give either `program`"),
        ({"program": "/nowhere"}, "no such file or folder"),
        ({"journal": "x", "program": ""}, "x cannot be read"),
        ({"speed": -1}, "speed is -1; it must be a number from 0 to 1e+06"),
        ({"run": [16]}, "run[0] is 16; it must be a whole number from 0 to 15"),
    ],
)
def test_a_launch_that_cannot_be_is_refused(
    client: Client, tmp_path: Path, arguments: dict[str, object], text: str
) -> None:
    with pytest.raises(RefusedError, match=re.escape(text)):
        client.launch(write(tmp_path), **arguments)
    with pytest.raises(RefusedError, match="no card is debugged yet"):
        client.ask("threads")
    assert client.end() == 0


@pytest.mark.parametrize(
    ("data", "sentence"),
    [
        (b"hello\r\n\r\n", r"b'hello\\r\\n' is not a header"),
        (b"x" * 10_000, r"b'x{60}' is not a header"),
        (b"Content-Length: x\r\n\r\n", "Content-Length b'x': a number of bytes, at most 16777216"),
        (
            b"Content-Length: 16777217\r\n\r\n",
            "Content-Length b'16777217': a number of bytes, at most 16777216",
        ),
        (b"Content-Type: 1\r\n\r\n", "a message has no Content-Length"),
        (b"Other: 1\r\nContent-Length: 2\r\n\r\n{}", r"b'Other: 1\\r\\n' is not a header"),
        (b"POST /a:b HTTP/1.1\r\nContent-Length: 2\r\n\r\n{}", r"b'POST .+' is not a header"),
        (b"Content-Length: 2\r\n\r\n[]", "a message is no JSON object"),
        (b"Content-Length: 1\r\n\r\n{", r"a message is no JSON: .+"),
    ],
)
def test_what_is_no_message_ends_the_connection_with_a_sentence(data: bytes, sentence: str) -> None:
    out = BytesIO()
    with pytest.raises(BrokenStreamError, match=f"^{sentence}$"):
        serve(BytesIO(data), out)
    assert out.getvalue() == b""


@pytest.mark.parametrize("data", [b"", b"Content-Length: 5\r\n\r\n{"])
def test_the_end_of_the_stream_ends_the_session(data: bytes) -> None:
    out = BytesIO()
    serve(BytesIO(data), out)
    assert out.getvalue() == b""


def test_a_broken_stream_ends_the_debugger_with_its_sentence() -> None:
    done = warm.run(["debug"], input=b"hello\r\n\r\n", capture_output=True, timeout=60)
    assert (done.returncode, done.stdout) == (2, b"")
    assert done.stderr == b"error: b'hello\\r\\n' is not a header\n"


def test_a_journal_with_own_devices_needs_their_folder(client: Client, tmp_path: Path) -> None:
    journal = str(tmp_path / "a.journal")
    (tmp_path / "lamp.py").write_text(LAMP)
    world = parse_world('[[device]]\nkind = "lamp.py:Lamp"\ninputs = { lit = 10 }\n')
    card = Controller(world=world, device_folder=tmp_path)
    card.recorder = Recorder(card, tmp_path / "a.journal")
    card.advance(500)
    card.close()
    with pytest.raises(RefusedError, match="lamp"):
        client.launch(tmp_path, program="", journal=journal)
    client.ask("launch", journal=journal, devices=str(tmp_path), speed=0, stopOnEntry=True)
    client.ask("configurationDone")
    assert client.stop()[0] == "entry"
    assert client.end() == 0


@pytest.mark.parametrize("last", ["disconnect", "terminate"])
def test_the_end_of_a_session_over_tcp_waits_for_no_client_and_no_other_gets_in(last: str) -> None:
    with warm.Popen(["debug", "--port", "0"], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        secret = process.stdout.readline().split('"')[3]
        port = int(process.stdout.readline().rsplit(":", 1)[1])
        with socket.create_connection(("127.0.0.1", port)) as client:
            with cast("IO[bytes]", client.makefile("rwb", buffering=0)) as stream:
                write_message(stream, {"seq": 1, "type": "request", "command": "initialize"})
                assert (read_message(stream) or {})["success"]
                assert (read_message(stream) or {})["event"] == "initialized"
                for given in (None, "", secret[1:], secret):
                    named = {"program": "no/such"} | ({} if given is None else {"secret": given})
                    launch = {"seq": 2, "type": "request", "command": "launch", "arguments": named}
                    write_message(stream, launch)
                    answer = read_message(stream) or {}
                    assert not answer["success"]
                    assert ("secret" in answer["message"]) == (given != secret)
                with pytest.raises(ConnectionRefusedError):
                    socket.create_connection(("127.0.0.1", port))
                write_message(stream, {"seq": 2, "type": "request", "command": last})
                assert process.wait(LIMIT_S) == 0


def test_nothing_is_answered_before_initialize() -> None:
    incoming, out = BytesIO(), BytesIO()
    for command in ("launch", "threads"):
        write_message(incoming, {"seq": 1, "type": "request", "command": command})
    incoming.seek(0)
    serve(incoming, out)
    out.seek(0)
    for command in ("launch", "threads"):
        answer = read_message(out) or {}
        assert answer["message"] == f"{command}: a session begins with initialize"


def test_a_scenario_that_is_not_played_is_named_with_what_plays_it(
    client: Client, tmp_path: Path
) -> None:
    write(tmp_path)
    scenario = tmp_path / "scenario.toml"
    scenario.write_text("duration_s = 1\n")
    client.ask("initialize", adapterID="openacr")
    client.ask("launch", program=str(tmp_path), stopOnEntry=True)
    assert client.event("output")["output"] == (
        f"note: {scenario} is not played here; `openacr run {tmp_path} --journal FILE`"
        " records a run with it, which a launch with `journal` debugs\n"
    )
