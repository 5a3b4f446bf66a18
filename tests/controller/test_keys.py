"""Ctrl-X, Ctrl-Y, Ctrl-Z and ESC (terminal protocol, section 7)."""

import pytest
from tests.controller.hosts import Host, connected, store

from openacr.channels import StreamKind

KAMR = (8467, 8499, 8531)
CTRL_X, CTRL_Y, CTRL_Z, ESC = "\x18", "\x19", "\x1a", "\x1b"


def kills(host: Host) -> list[bool]:
    return [host.card.bit[number] for number in KAMR]


def run_endless(host: Host) -> None:
    store(host, "_L", "DWL 0.01", "GOTO L")
    assert host.type("RUN") == "P00>"
    assert host.card.system.control.is_running(0)


@pytest.mark.parametrize("key", [CTRL_X, CTRL_Z])
def test_ctrl_x_and_z_kill_motion_and_programs_in_the_middle_of_a_line(
    axes: Host, key: str
) -> None:
    run_endless(axes)
    axes.send("X100\r")
    axes.card.advance(200)
    assert axes.send(f"?BIT{key}5") == "?BIT5"
    assert kills(axes) == [True] * 3
    assert not axes.card.system.control.is_running(0)
    axes.card.advance(4000)
    assert axes.send("16\r") == "16|0|P00>"
    assert axes.card.axis(0).commanded_u < 100
    assert axes.card.bit[8465] is (key == CTRL_X)


def test_ctrl_y_alone_sends_nothing_and_with_cr_one_prompt(axes: Host) -> None:
    axes.send(CTRL_X)
    assert axes.send(CTRL_Y) == ""
    assert axes.send(f"{CTRL_Y}\r") == "|P00>"
    assert kills(axes) == [False] * 3


def test_ctrl_x_acts_ahead_of_lines_that_wait(axes: Host) -> None:
    axes.send("DWL 1\rX10\r")
    axes.send(CTRL_X)
    assert kills(axes) == [True] * 3
    assert axes.after(4000) == "P00>Associated Slave Kill Motion Request Active|P00>"


def test_ctrl_x_ends_a_line_that_waits_for_room(axes: Host) -> None:
    axes.send("X100:X200:X300:X400\r")
    axes.card.advance(100)
    axes.send(CTRL_X)
    assert axes.after(100).endswith("P00>")
    assert axes.ask("?BIT8467") == "-1"


@pytest.mark.parametrize("first", [1808, 1872, 1904, 5808], ids=["FIFO", "COM1", "COM2", "DPCB"])
@pytest.mark.parametrize("model", ["ACR9000", "ACR8020"])
def test_requests_to_a_channel_clear_themselves_in_the_slow_scan(first: int, model: str) -> None:
    host = connected(model=model)
    host.type(f"SET {first}", f"SET {first + 1}", f"SET {first + 5}")
    assert host.asks(f"?BIT{first}", f"?BIT{first + 1}") == ["-1", "-1"]
    host.card.advance(100)
    flags = host.asks(f"?BIT{first}", f"?BIT{first + 1}", f"?BIT{first + 5}")
    assert flags == ["0", "0", "-1"], "high bit stripping is a setting and stays"


def test_an_escape_request_acts_as_esc_typed_on_that_channel(axes: Host) -> None:
    line = Host(axes.card, StreamKind.SERIAL)
    other = Host(axes.card, StreamKind.SERIAL)
    for host in (line, other):
        host.type("PROG0")
    store(axes, "_L", 'PRINT "tick"', "DWL 0.1", "GOTO L")
    axes.type("RUN", "LISTEN")
    assert (line.type("LISTEN"), other.type("LISTEN")) == ("", "")
    line.card.bit[1873] = True
    assert line.after(100).endswith("|P00>")
    assert other.heard() == axes.heard()
    assert "tick|" in axes.after(500)
    assert (other.heard()[:5], line.heard()) == ("tick|", "")
    assert not line.card.bit[1873]
    line.send("SET 3")
    line.card.bit[1873] = True
    line.card.advance(100)
    assert line.ask("?1") == "1", "as ESC, it drops what was typed"


def test_an_open_request_opens_nothing(axes: Host) -> None:
    line = Host(axes.card, StreamKind.SERIAL)
    line.card.bit[1872] = True
    line.card.advance(100)
    assert not line.card.bit[1866]
    assert line.ask("?1") == "1"


def test_esc_while_no_program_listens_discards_the_typed_text(host: Host) -> None:
    assert host.send(f"SET 32{ESC}") == "SET 32"
    assert host.send("\r") == "|SYS>"
    assert not host.card.bit[32]
    assert host.send(f"{ESC}{ESC}") == ""


def test_keys_count_on_every_stream(axes: Host) -> None:
    other = Host(axes.card)
    other.send(CTRL_X)
    assert kills(axes) == [True] * 3
    axes.send(CTRL_Y)
    assert kills(axes) == [False] * 3


@pytest.mark.parametrize("wait", ["P0 = GETCH", "_L:P0 = ASC(INKEY$):IF (P0 = 0) THEN GOTO L"])
def test_a_key_the_program_has_read_is_no_part_of_the_next_command(axes: Host, wait: str) -> None:
    axes.type("SYS", "DIM P(1)", "PROG0")
    store(axes, *wait.split(":", 1), "DWL 0.1")
    axes.type("LRUN")
    assert axes.send("k") == "k"
    assert axes.after(500) == "P00>"
    assert axes.ask("?P0") == "107"


def test_a_command_begun_while_a_program_ends_is_typed_on_at_the_prompt(axes: Host) -> None:
    axes.type("SYS", "DIM P(1)", "PROG0")
    store(axes, "P0 = GETCH", "DWL 0.1")
    axes.type("LRUN")
    assert axes.send("k?1+") == "k?1+"
    assert axes.after(500) == "P00>"
    assert axes.send("1\r") == "1|2|P00>"
    store(axes, "PRINT KBHIT")
    assert axes.type("LRUN") + axes.after(100) == "0|P00>"
