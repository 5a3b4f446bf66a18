"""Whatever arrives, the card answers, forgets it and keeps its axes on their way."""

import gc
import struct
import sys

import pytest
from tests.controller.hosts import X_AND_Y, Host, connected
from tests.soak.noise import Noise

from openacr.channels import StreamKind
from openacr.controller import Controller
from openacr.map import parameters

SET_UP = (
    "DIM P(100)", "DIM DEF(10)", "#DEFINE count P3", *X_AND_Y, "DIM LV(5)", "DIM SV(5)",
    "DIM DV(5)", "DIM $V(3,20)", "DIM LA(2)", "DIM LA0(5)",
)  # fmt: skip
VALUES = (
    0, 1, -1, 7, 16, 24, 255, 40000, 65535, 2**31 - 1, -(2**31), 1e-30, 0.5, 1e30, -1e38, 3.4e38,
)  # fmt: skip


def noisy_card() -> tuple[Host, Host]:
    """A card with a host that makes noise and one that does not."""
    host = Host(Controller())
    host.card.is_journalled = False
    host.type(*SET_UP)
    return host, Host(host.card)


def type_noise(noise: Noise, count: int, host: Host) -> None:
    """Lines and bytes; what a line starts may run on, what it waits for may never come."""
    for n in range(count):
        answer = host.send(noise.line() + "\r")
        assert "Traceback" not in answer
        host.card.advance(n % 3)
        if n % 50 == 0:
            host.send("\x1b")
            host.send(noise.raw())
        if n % 10 == 0 and host.card.streams.is_busy(host.stream):
            host.close()
            host.stream = host.card.open_stream(StreamKind.TERMINAL)
            host.send("PROG0\r")


def answers_everywhere(card: Controller) -> None:
    """Streams that no program holds open answer as ever."""
    card.system.restart()
    host = Host(card)
    assert host.ask("?1+1") == "2"


def many_lines(seed: int, count: int) -> None:
    host, quiet = noisy_card()
    noise = Noise(seed)
    for _ in range(count // 1000):
        type_noise(noise, 1000, host)
    quiet.close()
    answers_everywhere(host.card)


def test_five_thousand_lines_of_nonsense() -> None:
    many_lines(seed=1, count=5000)


@pytest.mark.soak
@pytest.mark.parametrize("seed", range(10, 20))
def test_lines_of_nonsense_for_minutes(seed: int) -> None:
    many_lines(seed, count=40_000)


def write_noise(seed: int, count: int) -> None:
    """Packets that write anything anywhere while axes move."""
    noise = Noise(seed)
    chance = noise.random
    places = list(parameters())
    for start in range(0, count, 500):
        host, text = noisy_card()
        packets = Host(host.card, StreamKind.PACKETS)
        host.type("X1000 Y500")
        for _ in range(min(500, count - start)):
            value, place = chance.choice(VALUES), chance.choice(places)
            long = max(-(2**31), min(2**31 - 1, int(value)))
            data = chance.choice(
                (
                    b"\0\x89" + struct.pack("<Hi", place, long),
                    b"\0\x8b" + struct.pack("<Hf", place, value),
                    b"\x1c" + struct.pack("<H", chance.randrange(20_000)),
                    noise.packet(),
                )
            )
            packets.send(data)
            text.send(noise.raw())
            host.card.advance(chance.choice((0, 1, 2, 120)))
        answers_everywhere(host.card)


def test_two_thousand_writes_anywhere() -> None:
    write_noise(seed=2, count=2000)


@pytest.mark.soak
@pytest.mark.parametrize("seed", range(20, 30))
def test_writes_anywhere_for_minutes(seed: int) -> None:
    write_noise(seed, count=20_000)


def test_noise_does_not_disturb_motion() -> None:
    quiet, noisy = connected(*X_AND_Y), connected(*X_AND_Y)
    others = [Host(noisy.card), Host(noisy.card, StreamKind.PACKETS)]
    others.append(Host(noisy.card, StreamKind.SERIAL))
    noise = Noise(3)
    for host in (quiet, noisy):
        host.card.advance(100)
        assert host.type("X30 Y-20", "X0 Y0") == "P00>P00>"
    for _ in range(600):
        for other in others:
            other.send(noise.harmless())
        quiet.card.advance(5)
        noisy.card.advance(5)
        for axis in (0, 1):
            ours, theirs = quiet.card.axis(axis), noisy.card.axis(axis)
            assert (ours.commanded_u, ours.actual_cnt) == (theirs.commanded_u, theirs.actual_cnt)
    assert quiet.asks("?P12288", "?BIT516") == noisy.asks("?P12288", "?BIT516") == ["0", "0"]


def test_memory_does_not_grow_with_what_hosts_send() -> None:
    host, other = noisy_card()
    noise = Noise(4)

    def work() -> int:
        for _ in range(500):
            other.send(noise.harmless())
            host.ask("?P12288")
            host.card.advance(1)
        gc.collect()
        return sys.getallocatedblocks()

    for _ in range(8):  # what is kept of packets has a bound, and comes to it
        work()
    before = work()
    assert work() - before < 1000


def test_output_that_is_not_read_is_bounded() -> None:
    host, other = noisy_card()
    text = "x" * 60
    lines = ("_L", *(f'PRINT "{text}"' for _ in range(9)), "GOTO L")
    host.type("PROGRAM", *lines, "ENDP", "LRUN")
    host.card.advance(40_000)
    taken = 0
    while data := host.card.take_output(host.stream):
        taken += len(data)
    assert taken <= 2 << 20
    assert other.ask("?5") == "5"
