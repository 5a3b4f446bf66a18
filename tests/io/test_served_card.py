"""A real card served by a process of its own, over real sockets and lines."""

import os
import signal
import socket
import struct
import sys
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import pytest
from tests.io.served import LOOPBACK, Caller, Served, openacr, serving
from tests.waiting import until

from openacr.client import Card as Client
from openacr.client import Level

POSIX = pytest.mark.skipif(sys.platform == "win32", reason="signals and terminals of POSIX")
AXIS = (
    "PROG0", "ATTACH MASTER0", 'ATTACH SLAVE0 AXIS0 "X"', "PPU X1000", "DRIVE ON X",
    "ACC 1000 DEC 1000 STP 1000 VEL 100",
)  # fmt: skip


def require_clean_end(served: Served) -> None:
    """The server ends with 0 and has reported nothing but what a busy computer brings about."""
    code, error = served.end()
    assert code == 0
    expected = ("refused: all streams are taken", "cannot keep real time")
    assert not [line for line in error.splitlines() if not line.endswith(expected)]


@pytest.fixture(scope="module")
def card() -> Iterator[Served]:
    """One server for all tests that leave it as they found it."""
    with serving() as served:
        yield served
        require_clean_end(served)


def prepare(host: Caller) -> None:
    for line in AXIS:
        assert host.ask(line).startswith(line)
    wait_for(host, "?BIT8465", "-1")


def wait_for(host: Caller, query: str, value: str) -> None:
    """Ask until the answer is this one; a busy machine may take its time."""
    until(lambda: host.value(query) == value, query)


def test_a_program_of_300_kb_is_downloaded_compared_and_read_back() -> None:
    text = "PROGRAM\n" + "".join(f" REM {n:05} {'x' * 190}\n" for n in range(1500)) + "ENDP\n"
    with serving("--no-journal") as served:
        with Client.open(f"127.0.0.1:{served.ascii_port}") as host:
            host.command("DIM PROG1(500000)")
            assert host.download(text, to=Level.program(1)).sent == 1502
            assert host.upload(Level.program(1)) == text
        require_clean_end(served)


def test_a_connection_is_silent_until_the_host_types(card: Served) -> None:
    with card.call() as host:
        host.socket.settimeout(0.1)
        with pytest.raises(TimeoutError):
            host.socket.recv(1)
        host.socket.settimeout(60)
        assert host.ask("?1+1") == "?1+1\r\n2\r\nSYS>"


def test_value_and_prompt_arrive_in_one_piece(card: Served) -> None:
    with card.call() as host:
        host.send(b"?P6916")
        host.until(b"?P6916")
        host.send(b"\r")
        answer = host.socket.recv(1000)
        assert answer.startswith(b"\r\n")
        assert answer.endswith(b"\r\nSYS>")


def test_four_hosts_at_once_and_a_fifth_is_turned_away(card: Served) -> None:
    hosts = [card.call() for _ in range(4)]
    prompts = [host.ask(f"PROG{n}")[-4:] for n, host in enumerate(hosts)]
    assert prompts == ["P00>", "P01>", "P02>", "P03>"]
    with card.call() as fifth:
        try:
            assert fifth.socket.recv(1) == b""
        except ConnectionResetError:
            pass
    for host in hosts:
        assert host.value("?2") == "2"
        host.socket.close()


def test_packets_on_both_ports(card: Served) -> None:
    request = bytes.fromhex("00 30 02 FF")
    with card.call() as text, card.call_binary() as packets:
        for host in (text, packets):
            host.send(request)
            assert host.exactly(4 + 32) == request + bytes(32)
        packets.send(bytes.fromhex("00 89 01 10 15 00 00 00 00 88 01 10"))
        assert packets.exactly(8) == bytes.fromhex("00 88 01 10 15 00 00 00")
        assert text.value("?P4097") == "21"
        packets.send(bytes.fromhex("00 89 01 10 00 00 00 00"))


def test_many_packet_connections_are_served(card: Served) -> None:
    hosts = [card.call_binary() for _ in range(8)]
    for host in hosts:
        host.send(bytes.fromhex("00 88 00 30"))
    assert [len(host.exactly(8)) for host in hosts] == [8] * 8
    for host in hosts:
        host.socket.close()


def test_a_dwell_lasts_its_time_by_the_clock(card: Served) -> None:
    with card.call() as host:
        require_dwell(host, "DWL 0.3", 0.29, 2.0)


def require_dwell(host: Caller, line: str, least_s: float, most_s: float) -> None:
    """It never takes less, and more only while the computer is busy."""
    end_s, took_s = time.monotonic() + 60, most_s
    while took_s >= most_s:
        began = time.monotonic()
        assert began < end_s
        host.ask(line)
        took_s = time.monotonic() - began
        assert took_s > least_s


def test_a_host_that_dies_frees_its_stream_and_disturbs_no_other(card: Served) -> None:
    with card.call() as stays:
        for _ in range(6):
            dies = card.call()
            dies.ask("PROG7")
            dies.send(b"INH 33\r?P12")
            dies.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
            dies.socket.close()
            assert stays.value("?3") == "3"
        require_answer(card)


def require_answer(card: Served) -> None:
    """A new host is served, as soon as the streams of those that have gone are free."""
    end_s = time.monotonic() + 60
    while True:
        with suppress(OSError, AssertionError), card.call() as host:
            assert host.ask("?4") == "?4\r\n4\r\nSYS>"
            return
        assert time.monotonic() < end_s


def test_a_host_that_does_not_read_is_not_waited_for() -> None:
    with serving() as served, served.call() as deaf, served.call() as other:
        text = b"x" * 70
        lines = [b"_L", *(b'PRINT "' + text + b'"' for _ in range(8)), b"GOTO L"]
        deaf.send(b"PROG0\rPROGRAM\r" + b"\r".join(lines) + b"\rENDP\rLRUN\r")
        for _ in range(50):
            assert other.value("?5") == "5"  # within the time-out of its socket
            time.sleep(0.01)
        deaf.socket.settimeout(60)
        assert text in deaf.exactly(20_000)
        code, error = served.end()
        assert (code, error.count("does not read")) in ((0, 0), (0, 1))


def test_moves_keep_real_time_and_go_on_when_the_host_has_gone() -> None:
    with serving() as served:
        with served.call() as host:
            prepare(host)
            host.ask("X30")
            assert host.value("?BIT516") == "-1"
        with served.call() as host:
            wait_for(host, "?BIT516", "0")
            assert host.value("?P12288") == "30000"


def test_card_time_may_run_faster_than_real_time() -> None:
    with serving("--speed", "5") as served, served.call() as host:
        require_dwell(host, "DWL 2", 0.39, 1.9)


@POSIX
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_signals_end_it_cleanly_in_the_middle_of_everything(number: signal.Signals) -> None:
    with serving() as served, served.call() as host, served.call_binary() as packets:
        prepare(host)
        host.ask("X1000")
        host.send(b"X2000\rX3000\r?P12")
        served.process.send_signal(number)
        out, err = served.process.communicate(timeout=60)
        assert (served.process.returncode, out, err) == (0, "", "")
        assert packets.socket.recv(1) == b""


def test_a_port_in_use_ends_it_with_2_and_a_hint(card: Served) -> None:
    ended = openacr("serve", "--ascii-port", str(card.ascii_port), "--binary-port", "0")
    assert ended.returncode == 2
    assert f"port {card.ascii_port} on 127.0.0.1 is in use" in ended.stderr
    assert "--ascii-port" in ended.stderr
    assert "Traceback" not in ended.stderr


def test_a_project_with_mistakes_is_refused_with_all_its_lines(tmp_path: Path) -> None:
    (tmp_path / "setup.8k").write_text("SYS\nfoo\nDIM P(10)\nbar\n")
    ended = openacr("serve", str(tmp_path))
    assert ended.returncode == 2
    assert [line.rpartition(":")[0][-2:] for line in ended.stderr.splitlines()] == [":2", ":4"]
    assert openacr("serve", str(tmp_path / "none")).returncode == 2


def test_a_project_is_loaded_and_its_boot_programs_run(tmp_path: Path) -> None:
    (tmp_path / "setup.8k").write_text("SYS\nDIM P(10)\nDIM PROG0(1000)\n")
    (tmp_path / "prog0.8k").write_text("PROGRAM\nPBOOT\nP1=42\nSET 32\nENDP\n")
    with serving(tmp_path) as served, served.call() as host:
        wait_for(host, "?BIT32", "-1")
        assert host.value("?P1") == "42"


def test_it_warns_when_other_machines_can_reach_it() -> None:
    with serving("--host", "0.0.0.0", "--insecure") as served:
        code, error = served.end()
        assert code == 0
        assert "WARNING" in error
        assert "every host that connects can move axes" in error


def test_the_warning_says_who_may_connect() -> None:
    options = ("--host", "0.0.0.0", "--allow", "192.168.10.0/24,10.0.0.7")
    with serving(*options) as served:
        _, error = served.end()
        assert "every host in 192.168.10.0/24, 10.0.0.7/32 can move axes" in error


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--host", "0.0.0.0"), "--allow 192.168.10.0/24, or allow all with --insecure"),
        (("--host", "0.0.0.0", "--allow", "10.0.0.0/8", "--insecure"), "exclude each other"),
        (("--allow", "10.0.0.0/99"), "write networks like"),
    ],
)
def test_who_may_connect_has_to_be_said_and_said_right(options: tuple[str, ...], said: str) -> None:
    ended = openacr("serve", *options)
    assert ended.returncode == 2
    assert said in ended.stderr


def test_the_terminal_command_talks_to_it(card: Served) -> None:
    ended = openacr("term", f"{LOOPBACK}:{card.ascii_port}", text="PROG3\n?1+1\nfoo\nSYS\n")
    assert (ended.returncode, ended.stderr) == (0, "")
    assert ended.stdout == "PROG3\nP03>?1+1\n2\nP03>foo\nUnknown command\nP03>SYS\nSYS>"


@POSIX
def test_a_serial_line_is_a_stream_of_its_own() -> None:
    import pty
    import tty

    ours, theirs = pty.openpty()
    tty.setraw(ours)
    with serving("--serial", os.ttyname(theirs)) as served, served.call() as network:
        assert network.ask("PROG5").endswith("P05>")
        os.write(ours, b"PROG1\r?1+1\r")
        seen = b""
        while seen.count(b">") < 2:
            seen += os.read(ours, 1000)
        assert seen == b"PROG1\r\nP01>?1+1\r\n2\r\nP01>"
        os.write(ours, bytes.fromhex("00 88 23 40 30"))  # MODE 1: 0x00 travels as "#@"
        reply = b""
        while len(reply) < 1 + 1 + 2 + 1 + 8:
            reply += os.read(ours, 1000)
        assert reply == bytes.fromhex("00 88 23 40 30") + b"#@" * 4
        assert network.value("?6") == "6"
        require_clean_end(served)
    os.close(theirs)
    os.close(ours)
