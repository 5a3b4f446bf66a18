"""Hosts that behave badly, many at once, over real sockets: axes and other hosts go on."""

import socket
import struct
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import pytest
from tests.io.served import LOOPBACK, Served, openacr, serving
from tests.io.test_served_card import prepare, wait_for

from openacr.controller.ring import journals

RESET = struct.pack("ii", 1, 0)
MODES = b"MODE 3\r\x00\x88#D&\x1bMODE 0\r\x00\x30\x02MODE 1\r\x00\x89\x01#PMODE 2\r"
PACKETS = bytes.fromhex("00 30 02 FF 00 88 00 30 00 FE")
Attack = Callable[[Served, threading.Event], None]


def half_open(served: Served, stop: threading.Event) -> None:
    """Say that nothing more comes, in the middle of a line or packet, and stay a while."""
    while not stop.is_set():
        for port in (served.ascii_port, served.binary_port):
            with suppress(OSError), connected(port) as held:
                held.sendall(b"?P12288\r?P1\x00\x88\x00")
                held.shutdown(socket.SHUT_WR)
                stop.wait(0.02)


def resets(served: Served, stop: threading.Event) -> None:
    """Come, begin something, and vanish."""
    while not stop.is_set():
        with suppress(OSError), connected(served.ascii_port) as gone:
            gone.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, RESET)
            gone.sendall(b"INH 40\r?P1")
        stop.wait(0.005)


def modes(served: Served, stop: threading.Event) -> None:
    """Change MODE in the middle of packets, without end, and read what comes."""
    flood(served.ascii_port, MODES * 20, stop, reads=True)


def packets(served: Served, stop: threading.Event) -> None:
    """Ask without end and never read an answer."""
    flood(served.binary_port, PACKETS * 100, stop, reads=False)


def crumbs(served: Served, stop: threading.Event) -> None:
    """One byte at a time, of packets that are never whole within the time-out."""
    with suppress(OSError), connected(served.binary_port) as slow:
        while not stop.is_set():
            slow.sendall(b"\x00")
            stop.wait(0.03)


def flood(port: int, data: bytes, stop: threading.Event, *, reads: bool) -> None:
    with suppress(OSError), connected(port) as flooding:
        flooding.settimeout(0.05)
        while not stop.is_set():
            with suppress(TimeoutError):
                flooding.sendall(data)
                if reads:
                    flooding.recv(1 << 16)


def connected(port: int) -> socket.socket:
    return socket.create_connection((LOOPBACK, port), timeout=60)


ATTACKS: tuple[Attack, ...] = (half_open, resets, modes, packets, packets, crumbs)


@pytest.mark.timeout(120)
def test_axes_move_and_hosts_are_answered_under_attack_and_it_can_be_replayed(
    tmp_path: Path,
) -> None:
    stop = threading.Event()
    with serving("--journal", tmp_path) as served, served.call() as host, served.call() as other:
        prepare(host)
        threads = [threading.Thread(target=attack, args=(served, stop)) for attack in ATTACKS]
        for thread in threads:
            thread.start()
        began = time.monotonic()
        host.ask("VEL 10 X15")
        while time.monotonic() - began < 1.2:
            assert other.value("?5") == "5"  # within the time-out of its socket
        wait_for(host, "?BIT516", "0")
        took_s = time.monotonic() - began
        stop.set()
        for thread in threads:
            thread.join()
        assert host.value("?P12288") == host.value("?P12289") == "15000"
        assert took_s > 1.5
        assert other.value("?6") == "6"
        code, error = served.end()
    assert code == 0
    assert "Traceback" not in error
    (journal,) = journals(tmp_path)
    replayed = openacr("replay", str(journal), "--check")
    assert replayed.returncode == 0, replayed.stderr
