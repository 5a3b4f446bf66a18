"""Snapshots in a file: complete, and safe to read from a stranger."""

import pickle
import zlib
from dataclasses import replace
from typing import Any

import msgspec
import pytest
from tests.controller.hosts import Host, at_axes, store

from openacr.controller import Controller, snapshot
from openacr.errors import StoreError


def busy_host() -> Host:
    """Axes that move, a program that waits, a line half typed, a packet half sent."""
    host = at_axes()
    store(host, "_L", "PRINT P0", "P0 = P0 + 1", "DWL 0.05", "GOTO L")
    host.type("SYS", "DIM P(10)", "FLASH SAVE", "ESAVE", "PROG0", "RUN", "X30 Y-10", "X0")
    host.card.advance(50)
    host.send("LRUN\r\x1bPRINT 1")
    return host


def test_a_card_from_a_file_goes_on_as_the_one_it_was_taken_from() -> None:
    host = busy_host()
    other = Host(host.card)
    host.card.receive(other.stream, b"?P0:DWL 0.1\r?P1\r\x00\x18")
    data = snapshot.encode(host.card.snapshot())
    assert len(data) < 100_000
    again = Controller("ACR9000")
    again.take_over(snapshot.decode(data))
    assert again.digest() == host.card.digest()
    assert again.lived_tk == host.card.lived_tk
    for card in (host.card, again):
        card.advance(300)
        card.receive(other.stream, b"\x00\x01")
        card.receive(host.stream, b"+1\rLIST\r")
        card.advance(3000)
    heard = [_heard(card, host.stream, other.stream) for card in (host.card, again)]
    assert heard[0][0].endswith(heard[1][0])
    assert "+1|2|P00>" in heard[1][0]
    assert heard[0][1].endswith(heard[1][1])
    assert again.digest() == host.card.digest()
    for card in (host.card, again):
        card.receive(host.stream, b"HALT ALL\rREBOOT\r")
        card.advance(100)
    assert again.digest() == host.card.digest()
    assert not again.system.programs.is_empty(0)


def _heard(card: Controller, *streams: int) -> list[str]:
    found = []
    for stream in streams:
        data = b""
        while part := card.take_output(stream):
            data += part
        found.append(data.decode("latin-1").replace("\r\n", "|"))
    return found


def test_a_card_returns_to_what_was_stored() -> None:
    card = Controller()
    card.send("AXIS0 PPU 5\rESAVE\r")
    before = card.snapshot()
    card.send("AXIS0 PPU 6\rESAVE\r")
    card.restore(before)
    card.send("REBOOT\r")
    assert card.send("AXIS0 PPU\r").splitlines()[1] == "5"


def test_a_battery_that_was_reset_stays_so() -> None:
    first, second = Controller("ACR8020"), Controller("ACR8020")
    first.send("PROG0\r10 PRINT 1\rSYS\rBRESET\r")
    second.take_over(snapshot.decode(snapshot.encode(first.snapshot())))
    for card in (first, second):
        card.send("REBOOT\r")
        assert card.system.programs.is_empty(0)
    assert first.digest() == second.digest()


class Trap:
    """Unpickling this would run a command."""

    def __reduce__(self) -> tuple[object, tuple[str]]:
        return __import__("os").system, ("touch /tmp/openacr-was-here",)


@pytest.mark.parametrize(
    "part",
    [
        pickle.dumps(Trap()),
        b"cos\nsystem\n(S'true'\ntR.",
        b"cbuiltins\neval\n(S'1'\ntR.",
        b"copenacr.basic.system\nreplace\n.",
        b"copenacr.cli.main\nmain\n(tR.",
        b"copenacr.plc.control\nnothing\n.",
        b"no pickle at all",
    ],
)
def test_a_snapshot_that_would_run_code_is_refused(part: bytes) -> None:
    whole = Controller().snapshot()
    for name in ("language", "execution", "streams"):
        changed: dict[str, Any] = {name: part}
        with pytest.raises(StoreError, match="snapshot"):
            snapshot.decode(snapshot.encode(replace(whole, **changed)))


@pytest.mark.parametrize("data", [b"", b"nonsense", zlib.compress(msgspec.msgpack.encode([1]))])
def test_what_is_no_snapshot_is_refused(data: bytes) -> None:
    with pytest.raises(StoreError, match="cannot be read"):
        snapshot.decode(data)
