"""Stored programs from a host (terminal protocol, section 8)."""

import pytest
from tests.controller.hosts import Host, store


def test_lrun_shows_the_output_and_gives_the_prompt_back_at_the_end(axes: Host) -> None:
    store(axes, 'PRINT "one"', "DWL 0.1", 'PRINT "two>"')
    assert axes.send("LRUN\r") + axes.after(20) == "LRUN|one|"
    assert axes.after(300) == "two>|P00>"
    assert axes.ask("?1") == "1"


def test_a_run_time_error_is_shown_after_lrun(axes: Host) -> None:
    store(axes, "P4000=1")
    answer = axes.type("LRUN") + axes.after(100)
    assert answer.startswith("Error in PROG0 line ")
    assert answer.endswith("|P00>")
    assert answer.count(">") == 1


@pytest.mark.parametrize("line", ["RUN PROG0", "run prog0", "RUN"])
def test_run_is_answered_at_once(axes: Host, line: str) -> None:
    store(axes, "DWL 100")
    assert axes.send(f"{line}\r") == f"{line}|P00>"
    assert axes.card.system.control.is_running(0)


def test_an_endless_goto_does_not_slow_the_terminal(axes: Host) -> None:
    store(axes, "_L", "GOTO L")
    axes.type("RUN")
    axes.card.advance(100)
    assert [axes.ask("?P12288") for _ in range(10)] == ["0"] * 10  # no tick passes


def test_everything_after_then_is_conditional(axes: Host) -> None:
    axes.type("SYS", "DIM P(1000)", "PROG0")
    condition = "IF ((P12288=P12289) AND (P12544=P12545)) THEN P0=437:GOTO 1000"
    axes.type(f"10 {condition}", "20 P1=1", "30 END", "1000 P2=1")
    axes.type("RUN")
    axes.card.advance(100)
    assert axes.asks("?P0", "?P1", "?P2") == ["437", "0", "1"]


def test_input_asks_the_listening_stream(axes: Host) -> None:
    axes.type("SYS", "DIM P(10)", "PROG0")
    store(axes, '10 INPUT "N=";P0', "20 PRINT P0*2")
    assert axes.type("LRUN") + axes.after(50) == "N="
    assert axes.send("2") == "2"
    assert axes.send("1\r") + axes.after(50) == "1|42|P00>"
    assert axes.ask("?P0") == "21"


def test_a_program_may_hold_a_stream_open(axes: Host) -> None:
    other = Host(axes.card)
    axes.type("SYS", "DIM P(10)", "PROG0", "DIM $V(1,80)")
    store(
        axes, 'OPEN "STREAM3:" AS #1', 'PRINT #1,"name> "', "INPUT #1,$V0",
        'PRINT #1,"you are ";$V0', "CLOSE #1",
    )  # fmt: skip
    assert other.send("?1\r") == "?1|1|SYS>"
    axes.type("RUN")
    assert other.after(50).startswith("name> |")
    assert other.send("\x1bab\x04") == ""
    assert other.send("c\r") + other.after(50) == "you are \x1bab\x04c|"
    assert other.send("?2\r") == "?2|2|SYS>"
    assert axes.heard() == ""


def test_a_stream_that_is_open_when_its_host_leaves_serves_the_next_one(axes: Host) -> None:
    other = Host(axes.card)
    store(axes, 'OPEN "STREAM3:" AS #1', "DWL 1", 'PRINT #1,"hello"', "CLOSE #1")
    axes.type("RUN")
    axes.card.advance(100)
    other.close()
    following = Host(axes.card)
    assert following.send("?1\r") == ""
    assert following.after(3000) == "hello|"
    assert following.ask("?1") == "1"
