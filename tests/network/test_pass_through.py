"""DTALK: a terminal that talks to a drive."""

from pathlib import Path

import pytest
from tests.io.served import Caller, serving
from tests.network.talk import TIMEOUT, Bench, axis, control, talking

from openacr.channels import StreamKind

GET = 1
DIALOGUE = (
    'OPEN DTALK "COM2:9600,N,8,1" AS #1 : REM OPEN THE PORT',
    "P28672=1 : REM MUST MATCH",
    "P28673=0 : REM ARIES",
    "CLR11122 CLR11123 CLR11124",
    "SET11104",
)


def talking_bench() -> Bench:
    """As the published dialogue begins, up to DTALK X."""
    bench = Bench(talking(0))
    bench.type("ECHO 1")
    for line in DIALOGUE:
        assert "rror" not in bench.say(line, 0.0)
    assert bench.say("DTALK X") == "DTALK X"
    return bench


@pytest.mark.req("ACR-DTALK-21")
def test_a_plc_has_its_drive_talk_done_by_a_program() -> None:
    """Flags above 8191 are out of reach of a PLC line, the request to run a program is not."""
    bench = Bench(talking(0, address=1))
    bench.open(0)
    bench.type("PGAIN X0", "SYS", "DIM PLC0(100)", "DIM PROG1(500)")
    assert bench.type("PROG1", "PROGRAM", "SET 10505", "SET 10500", "ENDP", "PLC0") == ""
    assert bench.type("10 LD 128", "20 SET 10500") != ""
    assert bench.type("NEW", "10 LD 128", "20 OUT 1064", "RUN") == ""
    bench.card.drag(0, -70.0)
    bench.card.advance(seconds=0.5)
    assert bench.card.p[28693] == 0
    bench.card.bit[128] = True
    bench.card.advance(seconds=0.1)
    bench.card.bit[128] = False
    bench.card.advance(seconds=0.5)
    assert bench.card.p[28693] == 70


def test_requests_wait_while_a_terminal_has_the_line() -> None:
    bench = talking_bench()
    bench.card.bit[control(0, GET)] = True
    bench.card.advance(seconds=3.0)
    assert bench.card.bit[control(0, GET)]
    bench.escape()
    assert bench.card.until(control(0, GET), is_=False, timeout_s=1.0)
    assert bench.card.p[28674] == 2


def test_only_one_terminal_at_a_time() -> None:
    bench = talking_bench()
    other = bench.card.open_stream(StreamKind.TERMINAL)
    bench.card.receive(other, b"ECHO 4\rDTALK AXIS0\r")
    assert b"Device in use" in bench.card.take_output(other)
    bench.escape()
    bench.card.receive(other, b"DTALK AXIS0\r")
    bench.card.receive(other, b"TPE\r")
    bench.card.advance(seconds=0.1)
    assert b"*0" in bench.card.take_output(other)
    bench.card.close_stream(other)
    assert bench.say("DTALK X") == "DTALK X", "who is gone holds nothing"


def test_typing_is_shown_and_can_be_corrected() -> None:
    bench = talking_bench()
    assert bench.card.send("TPX") == "TPX"
    assert bench.card.send("\x08") == "\b \b"
    assert bench.say("E") == "E|*0"
    assert bench.say("") == ""
    assert bench.say("x" * 200, 0.3).count("x") == 79


def test_a_silent_drive_says_nothing_and_sets_the_flag() -> None:
    bench = Bench(talking(0, powered_s=99.0))
    bench.open(0)
    bench.type("DTALK X")
    assert bench.say("TPE", 1.2) == "", "with ECHO 4 not even what is typed"
    assert bench.troubles() == [TIMEOUT]
    assert bench.escape() == "\r\n"
    assert bench.type("?1") == "1"


def test_lines_typed_ahead_are_sent_one_after_the_other() -> None:
    bench = talking_bench()
    bench.card.send("TPE\rDMODE\rTADDR\r")
    bench.card.advance(seconds=0.3)
    assert bench.card.take_output(bench.card.console).decode().split() == ["*0", "*2", "*1"]


def test_commands_of_one_line_are_answered_together() -> None:
    bench = talking_bench()
    assert bench.say("TADDR:DMODE:FOO:") == "TADDR:DMODE:FOO:|*1|*2|*UNDEFINED COMMAND|"
    assert bench.say("SMPER-4") == "SMPER-4|*INVALID DATA"
    assert bench.say("DMODE4") == "DMODE4|*INVALID DATA"
    assert bench.say("1_TADDR") == "1_TADDR|*1"
    assert bench.say("2_TADDR", 1.1) == "2_TADDR"


def test_a_snapshot_returns_to_the_middle_of_a_conversation() -> None:
    bench = talking_bench()
    bench.card.send("TADDR\r")
    snapshot = bench.card.snapshot()
    bench.escape()
    bench.card.restore(snapshot)
    bench.card.advance(seconds=0.1)
    assert bench.card.take_output(bench.card.console) == b"*1\r\n"
    assert bench.say("DMODE") == "DMODE|*2"
    assert bench.escape() == "\r\nP00>"


def test_a_restart_of_the_card_ends_a_conversation() -> None:
    bench = talking_bench()
    other = bench.card.open_stream(StreamKind.TERMINAL)
    bench.card.receive(other, b"REBOOT\r")
    assert bench.type("ECHO 4") != ""
    assert bench.type("?1+1") == "2"


@pytest.mark.req("ACR-CMD-DTALK")
def test_a_terminal_on_the_network_talks_to_the_drive_of_its_axis(tmp_path: Path) -> None:
    (tmp_path / "machine.toml").write_text(axis(0) + talking(0, revision="2.05"))
    set_up = 'PROG0\nATTACH MASTER0\nATTACH SLAVE0 AXIS0 "X"\n'
    (tmp_path / "setup.8k").write_text(set_up)
    with serving(str(tmp_path)) as server, Caller(server.ascii_port) as host:
        assert host.ask("PROG0") == "PROG0\r\nP00>"
        assert "Device not open" in host.ask("DTALK X")
        for line in DIALOGUE:
            assert host.ask(line).endswith("\r\nP00>")
        host.ask("INH -11104")
        host.send(b"DTALK X\r")
        assert host.until(b"\r\n") == b"DTALK X\r\n"
        host.send(b"TREV\r")
        assert b"Aries OS Revision 2.05" in host.until(b"2.05\r\n")
        host.send(b"?1+1\r")
        assert b"UNDEFINED COMMAND" in host.until(b"COMMAND\r\n")
        host.send(b"\x1b")
        assert host.until(b">") == b"\r\nP00>"
        assert host.value("?1+1") == "2"
