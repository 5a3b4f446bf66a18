"""Text on the port for packets, as a driver for the ACR9000 sends it that opens this port alone."""

import pytest
from tests.controller.hosts import Host

from openacr.channels import CHANNELS, StreamKind

GET = bytes.fromhex("00 88 02 30")  # P560
ZERO = bytes(4)


@pytest.fixture
def packets(host: Host) -> Host:
    """A host at the port for packets, beside one at the port for text."""
    host.type("DIM P(20)")
    return Host(host.card, StreamKind.PACKETS)


def padded(text: str) -> bytes:
    data = text.encode()
    return data + bytes(-len(data) % 4)


@pytest.mark.parametrize("line", ["?P0", "?P10", "?P 10", "? P 10", "PROG0", "VER", "", "?BIT 516"])
def test_a_padded_line_is_answered_as_on_the_port_for_text(packets: Host, line: str) -> None:
    text = Host(packets.card)
    wanted = text.send(f"{line}\r")
    data = padded(f"{line}\r")
    assert packets.send(data) == wanted
    assert packets.send(data) == text.send(f"{line}\r"), "the padding is complete"
    packets.card.receive(packets.stream, GET)
    assert packets.card.take_output(packets.stream) == GET + ZERO


@pytest.mark.parametrize("pad", range(4))
def test_packets_follow_the_padding_of_a_text_in_the_same_write(packets: Host, pad: int) -> None:
    line = "?P1" + " " * (-pad % 4)
    data = padded(line + "\r")
    assert len(data) - len(line) - 1 == pad
    packets.card.receive(packets.stream, data + GET + data)
    heard = b"".join(iter(lambda: packets.card.take_output(packets.stream), b""))
    answer = f"{line}\r\n0\r\nSYS>".encode()
    assert heard == answer + GET + ZERO + answer


def test_several_lines_of_a_text_are_padded_together(packets: Host) -> None:
    assert packets.send(padded("P1=7\r?P1\r")) == "P1=7|SYS>?P1|7|SYS>"
    assert packets.send(b"?P") == "?P"
    assert packets.send(b"1\r" + GET).startswith("1|7|SYS>"), "in any pieces"
    assert packets.send(b"?P" + GET).startswith("?P\0"), "a zero within a line begins a packet"
    assert packets.send(b"1\r") == "1|7|SYS>"


@pytest.mark.parametrize("begin", ["00", "04", "07", "1C", "1D", "1F"])
def test_what_begins_a_packet_is_one(packets: Host, begin: str) -> None:
    packets.card.receive(packets.stream, bytes.fromhex(begin))
    assert packets.card.streams.session(packets.stream) is None


def test_a_connection_takes_a_channel_with_its_first_text(packets: Host) -> None:
    card, names = packets.card, CHANNELS[StreamKind.TERMINAL]
    assert packets.send(GET + b"?P0\r") != "", "packets need no channel"
    assert card.streams.session(packets.stream) is None
    others = [Host(card) for _ in names[2:]]
    packets.send(b"?P0\r")
    session = card.streams.session(packets.stream)
    assert session is not None
    assert session.name == names[-1]
    late = Host(card, StreamKind.PACKETS)
    assert late.send(b"?P0\r") == "", "no channel is free"
    others[0].close()
    assert late.send(b"?P0\r") == "?P0|0|SYS>"
    packets.close()
    assert Host(card).ask("?P0") == "0", "its channel is free again"


def test_keys_and_levels_are_those_of_a_terminal(packets: Host) -> None:
    assert packets.send(padded("PROG3\r")) == "PROG3|P03>"
    assert packets.send(b"\x18\r\0\0") == "|P03>"
    assert packets.card.memory.bit(8467)
    assert packets.send(padded("ECHO 4\r")) == "ECHO 4|"
    assert packets.send(padded("?P3\r")) == "0|"


def test_a_text_goes_on_in_a_snapshot(packets: Host) -> None:
    packets.send(b"PROG2\r?P1\r\0")
    kept = packets.card.snapshot()
    packets.card.take_over(kept)
    heard = packets.send(b"\0" + GET + b"?P1\r")
    assert heard == (GET + ZERO).decode("latin-1") + "?P1|0|P02>"
    assert packets.card.streams.session(packets.stream) is not None
