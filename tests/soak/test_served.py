"""A served card under a flood of noise, and its pace over a minute."""

import re
import socket
import sys
import time
from pathlib import Path

import pytest
from tests.io.served import Caller, Served, serving
from tests.soak.noise import Noise

LINUX = pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="memory as Linux tells")
GROWTH_KIB = 30_000


def resident_kib(served: Served) -> int:
    text = Path(f"/proc/{served.process.pid}/status").read_text()
    found = re.search(r"VmRSS:\s+(\d+) kB", text)
    assert found is not None
    return int(found[1])


def flood(served: Served, seed: int, count: int) -> None:
    """Bytes, packets and lines over three connections; a fourth host is always answered."""
    noise = Noise(seed)
    with served.call() as watch:
        before = 0
        for at in range(count):
            with served.call() as text, served.call_binary() as packets:
                for _ in range(40):
                    text.send(noise.line().encode("latin-1", "replace") + b"\r")
                    text.send(noise.harmless())
                    packets.send(noise.packet() + noise.raw())
                reads(text)
            if at == count // 2:
                before = resident_kib(served)
            # any level may be left by what the noise has done to the whole card
            assert watch.value("?7") == "7"
        assert resident_kib(served) - before < GROWTH_KIB


def reads(host: Caller) -> None:
    """Take what has come, without waiting."""
    host.socket.setblocking(False)
    try:
        while host.socket.recv(65536):
            pass
    except (BlockingIOError, ConnectionResetError):
        pass


def ends_cleanly(served: Served) -> None:
    code, error = served.end()
    assert code == 0
    assert "Traceback" not in error
    assert "Fatal" not in error


@LINUX
def test_a_served_card_survives_a_flood_of_noise() -> None:
    with serving() as served:
        flood(served, seed=5, count=20)
        ends_cleanly(served)


@LINUX
@pytest.mark.soak
@pytest.mark.parametrize("seed", range(30, 34))
def test_a_served_card_survives_noise_for_minutes(seed: int) -> None:
    with serving() as served:
        flood(served, seed, count=600)
        ends_cleanly(served)


@pytest.mark.soak
def test_card_time_and_wall_clock_stay_together_for_two_minutes() -> None:
    with serving() as served, served.call() as host:
        host.ask("DIM P(10)")
        began_card, began = int(host.value("?P6916")), time.monotonic()
        worst_ms = 0.0
        while time.monotonic() - began < 120:
            time.sleep(0.05)
            card_ms = int(host.value("?P6916")) - began_card
            worst_ms = max(worst_ms, abs((time.monotonic() - began) * 1e3 - card_ms))
        assert worst_ms < 100
        ends_cleanly(served)


@pytest.mark.soak
@pytest.mark.skipif(sys.platform == "win32", reason="half-open connections of POSIX")
def test_a_thousand_connections_come_and_go() -> None:
    with serving() as served, served.call() as watch:
        for n in range(1000):
            with served.call() as host:
                if n % 3:
                    host.send(b"INH 40\r?P1")
                if n % 3 == 2:
                    host.socket.shutdown(socket.SHUT_WR)
            if n % 50 == 0:
                assert watch.value("?8") == "8"
        time.sleep(0.2)
        with served.call() as last:
            assert last.value("?9") == "9"
        ends_cleanly(served)
