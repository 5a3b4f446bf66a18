"""Bytes that mean nothing, on every kind of port: no crash, back in step, axes undisturbed."""

import gc
import struct
import sys

import numpy as np
import pytest
from tests.controller.hosts import X_AND_Y, Host, connected
from tests.soak.noise import Noise

from openacr.channels import BinaryMode, StreamKind
from openacr.map import numbers as at
from openacr.map.names import every_name
from openacr.map.rows import threads
from openacr.protocol.escape import encode_packet

MODEL = "ACR8020"  # the card with a port of every kind
GET = bytes.fromhex("00 88 04 1B")  # P6916, the clock, which nothing sets back
CLOCK = 6916
PER_CARD = 100_000  # bytes; what noise has set on a card goes with it
PER_CHECK = 5_000
TURNS_TK = 500  # in which the lines of a piece of noise have had their turns
TIMEOUTS = (
    at.P_FIFO_COMMUNICATION_TIMEOUT,
    at.P_COM1_COMMUNICATION_TIMEOUT,
    at.P_COM2_COMMUNICATION_TIMEOUT,
    at.P_DPCB_COMMUNICATION_TIMEOUT,
)
COUNTERS = (at.P_COM1_COMMAND_COUNTER, at.P_DPCB_COMMAND_COUNTER)


def sample(kind: StreamKind) -> bytes:
    """Packets of all kinds, one after the other, to be mutated."""
    words = (
        "00 30 02 FF", "00 88 00 30", "00 8A 00 30", "00 89 01 10 05 00 00 00",
        "00 90 01 01 31 50 40 00", "00 95 01 10 00 00 00 00 06 00 00 00", "1C 20 00",
        "1D 20 00", "07 01 00 00 00 00 00 3F", "1F 01 00 00 00 00 00 3F",
        "04 08 00 03 01 01 00 00 00 02 00 00 00",
    )  # fmt: skip
    mode = kind.startup_mode
    return b"".join(encode_packet(bytes.fromhex(each), mode) for each in words)


def trouble(noise: Noise, packets: bytes) -> bytes:
    """Some bytes: any, packets that lack something, lines that nearly mean something."""
    chance = noise.random
    kind = chance.randrange(4)
    if kind == 0:
        return chance.randbytes(chance.randrange(1, 400))
    if kind == 1:
        mutated = bytearray(packets)
        for _ in range(chance.randrange(1, 4)):
            mutated[chance.randrange(len(mutated))] = chance.randrange(256)
        cut = chance.randrange(len(mutated))
        return bytes(mutated[:cut] + mutated[cut + chance.randrange(3) :])
    if kind == 2:
        return b"".join(noise.packet() for _ in range(8))
    return b"".join(noise.line().encode("latin-1", "replace") + b"\r" for _ in range(4))


def back_in_step(port: Host, kind: StreamKind) -> None:
    """After the time-out a question is answered at once, by itself and rightly."""
    for timeout in TIMEOUTS:
        port.card.memory.write(timeout, 50)
    port.card.advance(110)
    if kind is StreamKind.SERIAL:
        port.card.receive(port.stream, b"\x11")
    if kind is not StreamKind.PACKETS:
        port.card.receive(port.stream, b"\x1b")
    port.heard()
    for _ in range(TURNS_TK):  # lines of the noise that wait for their turns come first
        if port.card.streams.is_answered(port.stream):
            break
        port.card.advance(1)
        port.heard()
    session = port.card.streams.session(port.stream)
    mode = BinaryMode(session.mode) if session else BinaryMode.PLAIN
    port.card.receive(port.stream, encode_packet(GET, mode))
    clock = struct.pack("<i", port.card.memory.read(CLOCK))
    heard = b""
    while data := port.card.take_output(port.stream):
        heard += data
    assert heard.endswith(encode_packet(GET + clock, mode)), heard


def fuzz(kind: StreamKind, seed: int, count: int) -> int:
    """Send bytes; how many questions were answered between."""
    noise, packets = Noise(seed), sample(kind)
    answered = sent = 0
    for _ in range(max(1, count // PER_CARD)):
        here = connected(*X_AND_Y, model=MODEL)
        here.card.is_journalled = False
        here.type("X1000 Y500")
        left = min(count, PER_CARD)
        while left > 0:
            port = Host(here.card, kind)
            part = min(left, PER_CHECK)
            while part > 0:
                data = trouble(noise, packets)
                port.card.receive(port.stream, data)
                port.heard()
                port.card.advance(noise.random.choice((0, 1, 2)))
                part -= len(data)
                left -= len(data)
                sent += len(data)
            if not is_taken(port):
                back_in_step(port, kind)
                answered += 1
            port.close()
    assert sent >= count
    return answered


def is_taken(port: Host) -> bool:
    """A program holds the stream OPEN, as the noise has set it: every byte is data there."""
    session = port.card.streams.session(port.stream)
    return session is not None and session.attention.value == "open"


@pytest.mark.parametrize("kind", list(StreamKind))
def test_a_hundred_thousand_bytes_of_trouble_on_every_kind_of_port(kind: StreamKind) -> None:
    assert fuzz(kind, seed=40, count=100_000) > 15


@pytest.mark.soak
@pytest.mark.parametrize("kind", list(StreamKind))
def test_ten_million_bytes_of_trouble_on_every_kind_of_port(kind: StreamKind) -> None:
    gc.collect()
    fuzz(kind, seed=41, count=PER_CARD)
    gc.collect()
    before = sys.getallocatedblocks()
    assert fuzz(kind, seed=42, count=10_000_000) > 1500
    gc.collect()
    assert sys.getallocatedblocks() - before < 20_000


# --- nothing valid: nothing changes ---------------------------------------------------------


def broken(noise: Noise, kind: StreamKind) -> bytes:
    """What never becomes a line or a packet that sets something."""
    chance = noise.random
    whole = encode_packet(bytes.fromhex("00 95 01 10 00 00 00 00 06 00 00 00"), kind.startup_mode)
    unknown = bytes((0, chance.choice((0x05, 0x70, 0x87, 0x8C, 0xFE))))
    plain = bytes((0, 0x88, 0x30, 0x31)) + bytes((0, 0x30, 0x32, 0x33))
    typed = bytes(chance.choice(b"qwzkj?!^~\x80\xc3\xff\t ;)") for _ in range(300)) + b"\x1b"
    return chance.choice((whole[: chance.randrange(1, 9)], unknown, plain, typed, b"zz\b\x7f\x1b"))


def moving_cards() -> tuple[list[Host], list[list[Host]]]:
    """Two cards on the same way, with a port of every kind each."""
    cards = [connected(*X_AND_Y, model=MODEL) for _ in range(2)]
    ports = [[Host(host.card, kind) for kind in StreamKind] for host in cards]
    for host in cards:
        host.card.advance(100)
        assert host.type("X30 Y-20", "X0 Y0") == "P00>P00>"
    return cards, ports


def test_where_nothing_is_valid_the_state_is_that_of_an_undisturbed_card() -> None:
    cards, ports = moving_cards()
    noise = Noise(6)
    for step in range(400):
        for port in ports[1]:
            port.send(broken(noise, kind_of(port)))
        for host in cards:
            host.card.advance(120)  # after the time-out of what is incomplete
        if step % 20 == 19:
            assert cards[0].card.digest() == cards[1].card.digest()
    assert cards[0].asks("?P12288", "?BIT516") == cards[1].asks("?P12288", "?BIT516") == ["0", "0"]


def test_refused_lines_change_the_counters_of_their_streams_alone() -> None:
    cards, ports = moving_cards()
    noise = Noise(7)
    for _ in range(300):
        for port in ports[1]:
            port.send(noise.harmless())
        for host in cards:
            host.card.advance(5)
    images = [np.frombuffer(host.card.image(), dtype=np.int32) for host in cards]
    changed = set(np.nonzero(images[0] != images[1])[0].tolist())
    channels = range(threads.ints[16], threads.ints[32])
    assert changed - set(channels) - waiting_rows() <= set(COUNTERS)
    assert changed & set(COUNTERS)


def waiting_rows() -> set[int]:
    """Rows that count what has been typed and not yet ended with CR."""
    counters = ("CHARACTER_COUNT", "LINE_COUNT")
    return {place for name, place in every_name().items() if name.endswith(counters)}


def kind_of(port: Host) -> StreamKind:
    return port.card.streams.state().open[port.stream].terminal.kind


# --- a MODE that changes in the middle -------------------------------------------------------


def test_mode_may_change_between_the_bytes_of_a_packet() -> None:
    host = connected(*X_AND_Y)
    port = Host(host.card, StreamKind.SERIAL)
    for old in range(4):
        for new in range(4):
            assert port.send(f"MODE {old}\r").endswith(">")
            wire = encode_packet(GET, BinaryMode(old))
            for cut in range(1, len(wire)):
                port.send(f"MODE {old}\r")
                port.card.receive(port.stream, wire[:cut])
                host.card.system.sessions["COM1"].mode = new  # as a program on the card would
                port.card.receive(port.stream, wire[cut:])
                # begun in the old mode, so read in it; the reply travels in the new one
                clock = struct.pack("<i", host.card.memory.read(CLOCK))
                assert port.heard().encode("latin-1").replace(b"|", b"\r\n") == encode_packet(
                    GET + clock, BinaryMode(new)
                )


def test_xon_and_xoff_between_the_bytes_of_a_packet_hold_and_free_the_output() -> None:
    host = connected()
    other, port = Host(host.card), Host(host.card, StreamKind.SERIAL)
    wire = encode_packet(GET, BinaryMode.PREFIX_CONTROLS)
    stop, go = b"\x13", b"\x11"
    for cut in range(1, len(wire)):
        port.card.receive(port.stream, wire[:cut] + stop + wire[cut:])
        assert port.card.take_output(port.stream) == b""
        assert other.ask("?3") == "3"
        port.card.receive(port.stream, go)
        reply = port.card.take_output(port.stream)
        assert reply.startswith(wire)
