"""The line discipline: the same events and bytes for any chunking."""

from collections.abc import Iterator

import pytest
from hypothesis import given
from hypothesis import strategies as st

from openacr.channels import Attention, BinaryMode, EchoMode, StreamKind
from openacr.protocol.bits import ClearBit, SetBit
from openacr.protocol.data import DataRequest
from openacr.protocol.events import (
    NEED_DATA,
    Control,
    ControlKey,
    Escape,
    Event,
    LineTooLong,
    Received,
    ReceivedLine,
    Typed,
)
from openacr.protocol.move import Move
from openacr.protocol.parameter import GetLong, SetLong
from openacr.protocol.terminal import Terminal

TIMEOUT_TK = 100
GET = bytes.fromhex("00 30 02 2C")
CHUNKS = (1, 2, 3, 7, 10_000)


def terminal(kind: StreamKind = StreamKind.TERMINAL, **settings: object) -> Terminal:
    made = Terminal(kind, timeout_tk=TIMEOUT_TK)
    for name, value in settings.items():
        setattr(made, name, value)
    return made


def events(stream: Terminal) -> Iterator[Event]:
    while (event := stream.next_event()) is not NEED_DATA:
        assert not isinstance(event, type(NEED_DATA))
        yield event


def answers(stream: Terminal, data: bytes, chunk: int = 10_000) -> tuple[list[Event], bytes]:
    """Feed in chunks; every line is answered by its length, every packet by `#`."""
    seen: list[Event] = []
    for at in range(0, len(data), chunk):
        stream.receive_data(data[at : at + chunk], 0)
        for event in events(stream):
            seen.append(event)
            if isinstance(event, ReceivedLine):
                stream.send_bytes(f"{len(event.text)}\r\nSYS>".encode())
            if isinstance(event, Received):
                stream.send_packet(b"\x00#")
    return seen, sent(stream)


def sent(stream: Terminal) -> bytes:
    return b"".join(iter(stream.data_to_send, b""))


SCRIPTS: dict[str, tuple[bytes, list[Event]]] = {
    "lines": (b"?P12288\rPROG0\r", [ReceivedLine("?P12288"), ReceivedLine("PROG0")]),
    "every line end": (
        b"A\rB\nC\r\nD\n\nE\r\r\n",
        [*map(ReceivedLine, ["A", "B", "C", "D", "", "E", ""])],
    ),
    "backspace": (b"\x08PX\x08\x7f\x7fQ\r", [ReceivedLine("Q")]),
    "delete": (b"PX\x7fQ\r", [ReceivedLine("PQ")]),
    "control keys": (
        b"AB\x18C\x19\x1a\r",
        [*map(Control, ControlKey), ReceivedLine("ABC")],
    ),
    "escape": (b"rubbish\x1bX1\r", [ReceivedLine("X1")]),
    "packet in a line": (
        b"?P1" + GET + b"2288\r",
        [Received(DataRequest(0x30, 2, 0x2C)), ReceivedLine("?P12288")],
    ),
    "packet before the LF": (
        b"A\r" + GET + b"\n\x1c\x08\x02B\r",
        [
            ReceivedLine("A"),
            Received(DataRequest(0x30, 2, 0x2C)),
            Received(SetBit(520)),
            ReceivedLine("B"),
        ],
    ),
    "set long": (
        bytes.fromhex("0089003010111200") + b"x\r",
        [Received(SetLong(12288, 0x121110)), ReceivedLine("x")],
    ),
    "typographic": ("PRINT “é”\r".encode(), [ReceivedLine("PRINT “é”")]),
    "windows": (b"PRINT \x93\xe9 \x94\xff\r", [ReceivedLine("PRINT \udc93\udce9 \udc94\udcff")]),
    "other controls": (b"\x01A\x03\tB\r", [ReceivedLine("A\tB")]),
    "long": (b"Z" * 256 + b"\rA\r", [LineTooLong(), ReceivedLine("A")]),
    "long but erased": (b"Z" * 257 + b"\x08\x08\r", [ReceivedLine("Z" * 255)]),
}


@pytest.mark.parametrize("chunk", CHUNKS)
@pytest.mark.parametrize("script", SCRIPTS)
def test_events_do_not_depend_on_the_chunking(script: str, chunk: int) -> None:
    data, expected = SCRIPTS[script]
    whole_events, whole_bytes = answers(terminal(), data)
    assert whole_events == expected
    assert answers(terminal(), data, chunk) == (whole_events, whole_bytes)


@given(
    data=st.lists(
        st.sampled_from(
            [b"A", b"\r", b"\n", b"\x08", b"\x18", b"\x1b", b"#", GET, b"\x1d\x20\x01A"]
        )
        | st.binary(min_size=1, max_size=3).filter(lambda b: not set(b) & {0x1C, 0x1D, 0x04, 0})
    ).map(b"".join),
    chunk=st.integers(1, 9),
    mode=st.sampled_from(list(map(BinaryMode, range(4)))),
    attention=st.sampled_from(Attention),
)
def test_any_bytes_in_any_chunks_give_the_same(
    data: bytes, chunk: int, mode: BinaryMode, attention: Attention
) -> None:
    one = terminal(mode=mode, attention=attention)
    other = terminal(mode=mode, attention=attention)
    assert answers(one, data) == answers(other, data, chunk)


def test_characters_are_echoed_as_typed_and_cr_as_cr_lf() -> None:
    stream = terminal()
    assert answers(stream, b'Prog0 ">"')[1] == b'Prog0 ">"'
    assert answers(stream, b"\r")[1] == b"\r\n9\r\nSYS>"


def test_the_answer_to_a_line_stands_before_the_echo_of_the_next() -> None:
    assert answers(terminal(), b"A\rBC\r")[1] == b"A\r\n1\r\nSYS>BC\r\n2\r\nSYS>"


def test_a_late_line_feed_after_cr_does_nothing() -> None:
    stream = terminal()
    assert answers(stream, b"A\r")[0] == [ReceivedLine("A")]
    assert answers(stream, b"\n") == ([], b"")
    assert answers(stream, b"\n")[0] == [ReceivedLine("")]


def test_erasing_moves_the_cursor_back_and_stops_at_the_start() -> None:
    assert answers(terminal(), b"A\x08\x7f")[1] == b"A\b \b"


def test_every_character_code_leaves_as_one_byte() -> None:
    stream = terminal()
    stream.send_bytes(bytes(range(256)))
    assert stream.data_to_send() == bytes(range(256))


def test_without_echo_nothing_typed_comes_back() -> None:
    stream = terminal(echo=EchoMode.NO_PROMPT)
    assert answers(stream, b"AB\x08\r")[1] == b"1\r\nSYS>"


def test_a_changed_echo_mode_counts_for_the_rest_of_the_same_segment() -> None:
    stream = terminal()
    stream.receive_data(b"ECHO 4\rA\r", 0)
    assert stream.next_event() == ReceivedLine("ECHO 4")
    stream.echo = EchoMode.NO_PROMPT
    assert stream.next_event() == ReceivedLine("A")
    assert sent(stream) == b"ECHO 4\r\n"


def test_control_keys_and_packets_are_not_echoed() -> None:
    assert answers(terminal(), b"\x18\x19\x1a\x1b")[1] == b""
    assert answers(terminal(), b"A" + GET + b"B")[1] == b"A\x00#B"


@pytest.mark.req("BIN-047")
def test_a_packet_reply_is_a_write_of_its_own() -> None:
    stream = terminal()
    stream.receive_data(b"?P1" + GET + GET + b"2\r", 0)
    for event in events(stream):
        if isinstance(event, Received):
            stream.send_packet(event.packet.encode())
        else:
            stream.send_bytes(b"0\r\nP00>")
    assert list(iter(stream.data_to_send, b"")) == [b"?P1", GET, GET, b"2\r\n0\r\nP00>"]


def test_while_a_line_is_busy_only_lines_wait() -> None:
    stream = terminal(busy=True)
    stream.receive_data(b"A\rB\r\x18C" + GET + b"D\r", 0)
    assert list(events(stream)) == [
        Control(ControlKey.CTRL_X),
        Received(DataRequest(0x30, 2, 0x2C)),
    ]
    assert stream.waiting_lines == 3
    stream.busy = False
    assert list(events(stream)) == [ReceivedLine("A"), ReceivedLine("B"), ReceivedLine("CD")]
    assert stream.waiting_characters == 0


def test_a_flood_is_held_back_until_lines_are_executed() -> None:
    stream = terminal(busy=True, echo=EchoMode(0))
    stream.receive_data(b"X1\r" * 30_000, 0)
    assert list(events(stream)) == []
    assert not stream.accepts_input
    stream.busy = False
    stream.next_event()
    stream.busy = True
    assert list(events(stream)) == []
    assert not stream.accepts_input  # room for one line is not worth a word to the sender
    stream.busy = False
    assert sum(1 for _ in events(stream)) == 29_999
    assert stream.accepts_input
    assert stream.waiting_characters == 0


def test_listening_hands_over_characters_until_escape() -> None:
    stream = terminal(attention=Attention.LISTENING)
    stream.receive_data(b"1\x082\r\x1b", 0)
    assert list(events(stream)) == [*map(Typed, b"1\x082\r"), Escape()]
    assert sent(stream) == b"1\b \b2\r\n"


def test_input_with_a_semicolon_keeps_the_cursor_on_its_line() -> None:
    stream = terminal(attention=Attention.LISTENING, echo_line_end=False)
    stream.receive_data(b"12\r", 0)
    assert list(events(stream)) == [*map(Typed, b"12\r")]
    assert sent(stream) == b"12"


def test_passing_through_echoes_nothing_and_keeps_every_character() -> None:
    stream = terminal(attention=Attention.PASS_THROUGH)
    stream.receive_data(b"T\x08\r\n\x18\x1b", 0)
    assert list(events(stream)) == [
        *map(Typed, b"T\x08\r\n"),
        Control(ControlKey.CTRL_X),
        Escape(),
    ]
    assert sent(stream) == b""


def test_an_open_stream_gives_its_program_every_byte_but_the_control_keys() -> None:
    stream = terminal(attention=Attention.OPEN)
    stream.receive_data(b"\x00\x1b\x08\x04A\r\n\x19", 0)
    assert list(events(stream)) == [
        *map(Typed, b"\x00\x1b\x08\x04A\r\n"),
        Control(ControlKey.CTRL_Y),
    ]
    assert sent(stream) == b""


def test_the_timeout_follows_the_setting_of_the_channel() -> None:
    stream = terminal()
    stream.timeout_tk = 2 * TIMEOUT_TK
    stream.receive_data(GET[:2], 0)
    stream.receive_data(GET[2:], 2 * TIMEOUT_TK)
    assert list(events(stream)) == [Received(DataRequest(0x30, 2, 0x2C))]


@pytest.mark.parametrize("flag", [SetBit(516), ClearBit(8467)])
@pytest.mark.parametrize("move", [Move.of({0: 2.0}), Move.of({0: 0.0}), Move.of({0: 1.5}, vel=2.0)])
def test_a_flag_packet_after_a_move_is_not_taken_for_its_last_bytes(
    move: Move, flag: SetBit | ClearBit
) -> None:
    stream = terminal()
    stream.receive_data(move.encode() + flag.encode(), 0)
    assert list(events(stream)) == [Received(move), Received(flag)]


def test_xoff_holds_the_output_of_a_serial_stream_only() -> None:
    serial, network = terminal(StreamKind.SERIAL), terminal()
    for stream in (serial, network):
        stream.receive_data(b"A\x13B", 0)
        list(events(stream))
    assert sent(serial) == b""
    assert sent(network) == b"AB"
    serial.receive_data(b"\x11", 0)
    list(events(serial))
    assert sent(serial) == b"AB"


def test_xon_inside_a_prefixed_packet_is_flow_control() -> None:
    stream = terminal(StreamKind.SERIAL)
    stream.receive_data(b"\x00\x88\x13\x11#@0", 0)
    assert list(events(stream)) == [Received(GetLong(12288))]


def test_the_binary_port_ignores_everything_but_packets_where_it_takes_no_text() -> None:
    stream = terminal(StreamKind.PACKETS)
    stream.receive_data(b"?P0\r\x18" + GET + b"\x1bX", 0)
    assert list(events(stream)) == [Received(DataRequest(0x30, 2, 0x2C))]
    assert sent(stream) == b""


def test_output_beyond_a_mebibyte_is_dropped_whole_until_some_is_taken() -> None:
    stream = terminal()
    stream.send_bytes(b"x" * ((1 << 20) - 1))
    stream.send_bytes(b"y")
    stream.send_bytes(b"SYS>")
    stream.send_packet(GET)
    assert stream.output.dropped_bytes == 8
    assert stream.data_to_send() == b"x" * 4096
    stream.send_bytes(b"SYS>")
    assert everything(stream) == b"x" * ((1 << 20) - 1 - 4096) + b"y" + b"SYS>"
    assert stream.output.dropped_bytes == 8


def test_one_answer_may_be_longer_than_what_is_kept_of_many() -> None:
    stream = terminal()
    stream.send_bytes(b"x" * (1 << 21))
    assert len(everything(stream)) == 1 << 21
    assert stream.output.dropped_bytes == 0


def test_long_text_leaves_in_writes_of_4_kib_and_a_packet_in_one() -> None:
    stream = terminal()
    stream.send_bytes(b"x" * 4096)
    stream.send_packet(b"\0" * 5000)
    stream.send_bytes(b"y" * 8193)
    sizes = [len(write) for write in iter(stream.data_to_send, b"")]
    assert sizes == [4096, 5000, 4096, 4096, 1]


def test_xoff_holds_back_what_is_left_of_a_long_text() -> None:
    stream = terminal(StreamKind.SERIAL)
    stream.send_bytes(b"x" * 5000)
    assert len(stream.data_to_send()) == 4096
    stream.receive_data(b"\x13", 0)
    list(events(stream))
    assert stream.data_to_send() == b""
    stream.receive_data(b"\x11", 0)
    list(events(stream))
    assert stream.data_to_send() == b"x" * 904


def everything(stream: Terminal) -> bytes:
    """All writes together."""
    return b"".join(iter(stream.data_to_send, b""))


@pytest.mark.parametrize("text", [b"?P5\r", b"PROG1\r\0\0", b"?P1228\r\0", b"?P12288\r"])
@pytest.mark.parametrize("chunk", CHUNKS)
def test_a_text_on_the_port_for_packets_takes_as_many_zeros_as_fill_its_unit(
    text: bytes, chunk: int
) -> None:
    """The next zero begins a packet."""
    stream = terminal(StreamKind.PACKETS, takes_text=True)
    seen, _ = answers(stream, text + GET, chunk)
    line = ReceivedLine(text.rstrip(b"\0\r").decode())
    assert seen == [line, Received(DataRequest(0x30, 2, 0x2C))]
