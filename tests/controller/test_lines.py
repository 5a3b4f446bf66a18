"""Lines in, echo and prompts out (terminal protocol, sections 2, 3 and 5)."""

import random

import pytest
from tests.controller.hosts import Host, at_axes, connected

from openacr.controller import Controller
from openacr.errors import UserError


def test_nothing_is_sent_before_the_host_says_something(host: Host) -> None:
    assert host.after(2000) == ""


def test_the_complete_picture_of_the_first_query(host: Host) -> None:
    host.send("PROG0\r")
    assert host.send("?P12288\r") == "?P12288|0|P00>"


def test_characters_are_echoed_as_they_arrive_and_the_line_may_end_later(host: Host) -> None:
    assert [host.send(c) for c in 'pRint ">"'] == list('pRint ">"')
    host.after(5000)
    assert host.send("\r") == "|>|SYS>"


@pytest.mark.parametrize("end", ["\r", "\r\n"])
def test_cr_and_cr_lf_end_a_line_once(host: Host, end: str) -> None:
    assert host.send(f"?1{end}?2{end}") == "?1|1|SYS>?2|2|SYS>"


def test_an_lf_in_the_next_segment_ends_no_second_line(host: Host) -> None:
    assert host.send("?1\r") == "?1|1|SYS>"
    host.after(100)
    assert host.send("\n") == ""
    assert host.send("?2\r") == "?2|2|SYS>"


def test_an_empty_line_gives_one_prompt(host: Host) -> None:
    assert host.send("\r\r") == "|SYS>|SYS>"


def test_case_and_blanks_are_free() -> None:
    axes = at_axes()
    assert axes.type("prog0", "Prog 0", "PROG  0", "ppu x 1000") == "P00>" * 4
    assert axes.ask("?bit8467") == "0"
    assert axes.type("BIT 32=1", "BIT33=1", "SET34", "X0   ", "jog abs x 0 y 0") == "P00>" * 5
    assert axes.asks("?BIT32", "? BIT 33", "?BIT(34)") == ["-1", "-1", "-1"]
    axes.type("CLR32", "CLR 33", "BIT34=0")
    assert axes.asks("?BIT32", "?BIT33", "?BIT34") == ["0", "0", "0"]


def test_hosts_that_never_leave_sys_have_what_they_need(host: Host) -> None:
    accepted = (
        "AXIS0 PPU 2000", "AXIS0 RES 1", "AXIS0 JOG VEL 10", "AXIS0 JOG ACC 100",
        "AXIS0 JOG DEC 100", "DRIVE ON AXIS0", "AXIS0 JOG INC 0.5", "AXIS0 JOG OFF",
        "BIT32=1", "SET 33", "CLR 33", "ECHO 1", "HALT ALL", "DIM P(10)",
    )  # fmt: skip
    assert host.type(*accepted) == "SYS>" * len(accepted)
    assert host.asks("?P12290", "?BIT32", "AXIS0 PPU") == ["2000", "-1", "2000"]
    assert host.type("VER").count("ACR9000") == 1


@pytest.mark.parametrize(
    "line", ["", "foo", "X1", "?1", "PRINT", "10", "IF", "REM > x", "\x80\xff"]
)
def test_every_line_is_answered_by_exactly_one_prompt_at_its_end(host: Host, line: str) -> None:
    answer = host.send(f"{line}\r")
    assert answer.removeprefix(line).count("SYS>") == 1
    assert answer.endswith("|SYS>")


def test_captured_lines_are_answered_by_a_prompt_each(host: Host) -> None:
    host.send("PROG0\r")
    assert host.send("PROGRAM\rX10\r\rfoo bar\rENDP\r").count("P00>") == 5


def test_mode_4_sends_nothing_but_values_and_errors(host: Host) -> None:
    assert host.send("ECHO 4\r") == "ECHO 4|"
    assert host.send("?P6916\r?BIT516\r") == "0|0|"
    assert host.send("\rPROG0\rfoo\r") == "Unknown command|"
    assert host.send("ECHO\rECHO 1\r?1\r") == "4|P00>?1|1|P00>"


@pytest.mark.parametrize(
    ("mode", "query", "error"),
    [
        (0, "1|SYS>", "Unknown command|SYS>"),
        (1, "?1|1|SYS>", "foo|Unknown command|SYS>"),
        (2, "1|SYS>", "SYS>"),
        (3, "?1|1|SYS>", "foo|SYS>"),
        (4, "1|", "Unknown command|"),
        (5, "?1|1|", "foo|Unknown command|"),
        (6, "1|", ""),
        (7, "?1|1|", "foo|"),
    ],
)
def test_echo_modes(host: Host, mode: int, query: str, error: str) -> None:
    host.send(f"ECHO {mode}\r")
    assert (host.send("?1\r"), host.send("foo\r")) == (query, error)


def test_a_line_of_255_characters_is_taken_and_a_longer_one_refused(host: Host) -> None:
    fits = "?1" + "+1" * 126
    assert host.ask(fits + " ") == "127"
    assert host.type(fits + "+1") == "Line too long|SYS>"
    assert host.ask("?2") == "2"


def test_backspace_and_delete_take_characters_back(host: Host) -> None:
    assert host.send("?12\b3\x7f4\r") == "?12\b \b3\b \b4|14|SYS>"


SESSION = (
    b"PROG0\rATTACH MASTER0\r\nATTACH SLAVE0 AXIS0 \"X\"\r\rPPU X1000\rATTACH\r\nfoo\r"
    b"?P(12288+256)\x00\x30\x02\x03:?2\r\x19X10\rX20\r?BIT516\rECHO 4\r?ACC\r?foo\rECHO 1\r"
    b"10 PRINT \">\"\r20 END\rLIST\r\x1bRUN\r\x1c\x20\x00?BIT32\r"
    b"ab\b\b\x7f\x08?3\r\x18PROG1\r?4\r\x19PROG0\rX50:X60:X70\r?5\r"
)  # fmt: skip


def test_any_chunking_gives_the_same_bytes() -> None:
    pieces = SESSION.splitlines(keepends=True)  # each is little work
    assert b"".join(pieces) == SESSION
    whole = connected().send_apart(SESSION, list(map(len, pieces)))
    assert whole.count(">") > 15
    assert "?BIT516|-1|P00>" in whole
    assert connected().send_apart(SESSION, [1] * len(SESSION)) == whole
    chance = random.Random(5)
    for _ in range(5):
        sizes = [chance.randrange(1, 12) for _ in range(40)]
        assert connected().send_apart(SESSION, sizes) == whole


@pytest.mark.parametrize(
    "line", ["ENC # SRC 15", "STEPPER # RES", "ATTACH MASTER #", "PRINT DAC #"]
)
def test_a_number_sign_is_no_object_number(host: Host, line: str) -> None:
    answer = host.type("PROG0", line).removeprefix("P00>")
    assert answer.endswith("|P00>")
    assert answer.count("|") == 1


def test_ask_returns_the_whole_of_a_long_list_and_leaves_nothing() -> None:
    card = Controller()
    body = "".join(f"PRINT {number}\r" for number in range(230))
    card.send(f"PROG0\rPROGRAM\r{body}ENDP\r")
    shown = [*(f" PRINT {number}" for number in range(230)), "ENDP"]
    assert card.ask("LIST\r").split("\r\n") == ["LIST", "PROGRAM", *shown, "P00>"]
    assert card.ask("?1\r") == "?1\r\n1\r\nP00>"
    assert len(card.send("LIST\r").split("\r\n")) == 1 + 20 + 1, "what `send` returns of it"


def test_ask_waits_for_every_line_and_for_the_end_of_a_followed_program() -> None:
    card = Controller()
    assert card.ask("DWL 0.2\r?1\r") == "DWL 0.2\r\n?1\r\nSYS>1\r\nSYS>"
    assert card.ask("DWL 0.1\r" + "?1\r" * 60).count("SYS>") == 61, "more than one turn"
    card.send("PROG0\r10 PRINT 7\r20 DWL 0.5\r30 PRINT 8\r")
    assert card.ask("LRUN\r") == "LRUN\r\n7\r\n8\r\nP00>"
    assert card.ask("RUN\r") == "RUN\r\nP00>", "RUN does not wait"


def test_ask_gives_up_after_its_time_of_the_card() -> None:
    card = Controller()
    card.send("PROG0\r")
    with pytest.raises(UserError, match=r"within 0\.5 s of the card: 'DWL 9"):
        card.ask("DWL 9\r", timeout_s=0.5)
    assert card.time_s == pytest.approx(0.5)
