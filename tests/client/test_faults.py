"""Lines and cards that are slow, noisy or gone."""

import pytest
from tests.client.cards import wrapped

from openacr.channels import EchoMode, StreamKind
from openacr.client import (
    Card,
    ConnectionLostError,
    GarbledError,
    Level,
    NoReplyError,
    Options,
)
from openacr.client.links import ProcessLink
from openacr.controller import Controller


@pytest.mark.parametrize("echo", [1, 4, 0])
@pytest.mark.parametrize("chunk", [1, 2, 5])
def test_a_slow_line_changes_nothing(echo: int, chunk: int) -> None:
    card, link = wrapped(Options(echo=EchoMode(echo)))
    link.chunk = chunk
    card.command("DIM PROG0(2000)")
    card.download('PROGRAM\nPRINT "P00>"\nENDP\n', to=Level.program(0))
    assert card.upload(Level.program(0)) == 'PROGRAM\n PRINT "P00>"\nENDP\n'
    assert card.read_many([12375, 12631]) == [1, 1]
    assert card.command("PRINT 1;") == ["1"]


def test_a_garbled_echo_is_an_error_and_the_next_request_is_clean() -> None:
    card, link = wrapped()
    card.go(Level.program(3))
    link.alters = lambda data: data.replace(b"?P", b"?\xd0")
    with pytest.raises(GarbledError, match=r"garbled reply to \?P1"):
        card.command("?P12375")
    link.alters = lambda data: data
    assert card.command("?P12375") == ["1"]
    assert card.level == Level.program(3)


def test_a_garbled_packet_is_an_error_and_the_next_one_is_clean() -> None:
    card, link = wrapped()
    link.alters = lambda data: data.replace(b"\x00\x88", b"\x00\x8c")
    with pytest.raises(GarbledError):
        card.read(4097)
    link.alters = lambda data: data
    assert card.read(4097) == 0


def test_a_silent_card_is_reported_and_left_alone() -> None:
    card, link = wrapped(Options(timeout_s=0.2))
    link.alters = lambda data: b""
    with pytest.raises(NoReplyError, match=r"no reply within 0\.2 s to \?1"):
        card.command("?1")
    with pytest.raises(TimeoutError):
        card.command("?1")
    link.alters = lambda data: data
    assert card.command("?2") == ["2"]


def test_a_late_answer_is_not_taken_for_the_next_one() -> None:
    card, _ = wrapped(Options(timeout_s=0.2))
    with pytest.raises(NoReplyError):
        card.command("DWL 0.35 : ?111")
    assert card.command("?222", timeout_s=1) == ["222"]


@pytest.mark.parametrize("where", ["write", "read"])
def test_a_query_survives_a_broken_connection_at_the_same_level(where: str) -> None:
    card, link = wrapped()
    card.command("DIM LV(2)", program=5)
    card.command("LV1=7", program=5)
    link.breaks_at = [where]
    assert card.ask("LV1") == 7
    assert card.level == Level.program(5)
    assert link.opened == 2


def test_a_command_is_not_sent_twice_but_the_next_one_reconnects() -> None:
    card, link = wrapped()
    card.command("DIM P(5)")
    link.breaks_at = ["read"]
    with pytest.raises(ConnectionLostError):
        card.command("P0=P0+1")
    assert card.command("P1=1") == []
    assert card.p[0] == 1


def test_reconnecting_is_tried_for_some_time_only() -> None:
    card, link = wrapped(Options(reconnect_s=3.0))
    link.breaks_at, link.is_reachable = ["write"], False
    begin_s = card.now_s()
    with pytest.raises(ConnectionLostError, match="cannot connect"):
        card.read(4097)
    assert card.now_s() - begin_s == pytest.approx(3.0, abs=2.0)
    link.is_reachable = True
    assert card.read(4097) == 0


@pytest.mark.parametrize(
    ("reconnect_s", "cut_s"), [(2.0, 0.7), (2.0, 1.2), (2.0, 1.7), (30.0, 9.0)]
)
def test_a_connection_is_back_soon_after_the_link(reconnect_s: float, cut_s: float) -> None:
    """Within a tenth of the time for which it is tried, and of 2 s at most."""
    card, link = wrapped(Options(reconnect_s=reconnect_s))
    begin_s, opens = card.now_s(), link.open

    def opened() -> None:
        link.is_reachable = card.now_s() - begin_s >= cut_s
        opens()

    link.breaks_at, link.open = ["write"], opened  # type: ignore[method-assign]
    assert card.read(4097) == 0
    assert cut_s <= card.now_s() - begin_s <= cut_s + min(reconnect_s / 10, 2.0) + 0.1


def test_a_first_connection_that_fails_is_reported_at_once() -> None:
    card, link = wrapped()
    card.close()
    link.is_reachable = False
    begin_s = card.now_s()
    with pytest.raises(ConnectionLostError):
        card.connect()
    assert card.now_s() == begin_s


def test_without_reconnection_a_broken_connection_is_an_error() -> None:
    card, link = wrapped(Options(reconnect_s=0))
    link.breaks_at = ["read"]
    with pytest.raises(ConnectionError):
        card.read(4097)


def test_a_download_without_answer_leaves_no_half_program() -> None:
    card, link = wrapped()
    card.command("DIM PROG0(2000)")
    link.alters = lambda data: b"" if b"P1=2" in data else data
    with pytest.raises(NoReplyError):
        card.download("PROGRAM\nP0=1\nP1=2\nENDP\n", to=Level.program(0))
    assert card.upload(Level.program(0)) == ""


def test_a_download_over_a_broken_connection_leaves_no_half_program() -> None:
    card, link = wrapped()
    card.command("DIM PROG0(2000)")

    def break_after(done: int, _: int) -> None:
        link.breaks_at = ["read"] if done == 2 else []

    with pytest.raises(ConnectionLostError):
        card.download("PROGRAM\nP0=1\nP1=2\nENDP\n", to=Level.program(0), progress=break_after)
    assert card.upload(Level.program(0)) == ""


def test_a_download_that_is_interrupted_leaves_no_half_program() -> None:
    card, link = wrapped()
    card.command("DIM PROG0(2000)")
    interrupts = [KeyboardInterrupt()]

    def interrupt(data: bytes) -> bytes:
        if b"P1=2" in data and interrupts:
            raise interrupts.pop()
        return data

    link.alters = interrupt
    with pytest.raises(KeyboardInterrupt):
        card.download("PROGRAM\nP0=1\nP1=2\nENDP\n", to=Level.program(0))
    assert card.upload(Level.program(0)) == ""


class StreamLink(ProcessLink):
    """A serial line of a card in this process, in the state another host has left it in."""

    kind = StreamKind.SERIAL

    def __init__(self, card: Controller, stream: int) -> None:
        super().__init__(card)
        self._stream = stream

    def open(self) -> None:
        pass


def serial_line(*typed: bytes) -> Card:
    """A client of a serial line on which another host has typed."""
    controller = Controller()
    stream = controller.open_stream(StreamKind.SERIAL)
    for data in typed:
        controller.receive(stream, data)
    while controller.take_output(stream):
        pass
    return Card(StreamLink(controller, stream))


@pytest.mark.parametrize("mode", [0, 1, 3])
def test_packets_travel_in_the_mode_the_serial_line_has(mode: int) -> None:
    card = serial_line(b"MODE %d\r" % mode)
    card.p[4097] = 0x12130411
    card.p[4098] = -2
    assert card.read_many([4097, 4098]) == [0x12130411, -2]
    assert card.command("MODE") == [str(mode)]


@pytest.mark.parametrize(
    "typed",
    [
        b"?P12",
        b"PROG3\rECHO 7\r",
        b"DIM PROG0(500)\rPROG0\rECHO 4\rPROGRAM\rP0=",
        b'DIM PROG0(500)\rPROG0\r10 PRINT "x"\r20 GOTO 10\rLRUN\r',
    ],
    ids=["half a line", "echo 7", "inside a program", "listening"],
)
def test_what_another_host_left_on_a_serial_line_does_not_matter(typed: bytes) -> None:
    card = serial_line(typed)
    assert card.ask("6") == 6
    assert card.level == Level()
    assert card.p["axis0.ppu"] == 1


def test_without_a_free_stream_there_is_no_connection() -> None:
    controller = Controller()
    cards = [Card.open(controller) for _ in range(4)]
    with pytest.raises(ConnectionLostError, match="stream is free"):
        Card.open(controller)
    cards[0].close()
    Card.open(controller).close()
