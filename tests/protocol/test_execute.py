"""Packets acting on a card."""

import pytest
from tests.controller.hosts import Host, at_axes

from openacr.channels import StreamKind
from openacr.map.words import mf1


@pytest.fixture
def packets() -> Host:
    """The packet port of a card whose X moves."""
    return Host(at_axes().card, StreamKind.PACKETS)


def ask(host: Host, request: str) -> bytes:
    return host.raw(bytes.fromhex(request))


def place(host: Host) -> float:
    """Where X is, a second later [pulses]."""
    host.card.advance(seconds=1.0)
    return host.card.p[12288]


def test_a_value_that_is_no_number_changes_nothing(packets: Host) -> None:
    before = packets.card.digest()
    assert ask(packets, "00 8B 00 20 00 00 C0 7F") == b""
    assert ask(packets, "07 01 00 00 00 00 C0 7F") == b""
    assert ask(packets, "04 08 00 01 04 00 00 C0 7F") == b""
    assert packets.card.digest() == before


def test_an_unknown_conversion_code_is_not_answered(packets: Host) -> None:
    assert ask(packets, "00 90 03 01 01 00 60 00") == b""


def test_a_refused_move_sends_nothing_back(packets: Host) -> None:
    assert ask(packets, "04 00 00 01 E8 03 00 00") == b""
    assert place(packets) == 1000.0
    packets.card.memory.I[mf1.word[0]] |= mf1.KILL_ALL_MOVES_REQUEST
    assert ask(packets, "04 00 00 01 D0 07 00 00") == b""
    assert place(packets) == 1000.0
