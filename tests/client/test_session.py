from collections.abc import Iterable

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from openacr.channels import BinaryMode, EchoMode
from openacr.client.requests import (
    SYS,
    Align,
    Answer,
    Ask,
    Follow,
    Heard,
    Leave,
    Level,
    Line,
    Press,
    Request,
)
from openacr.client.session import Session
from openacr.errors import UserError
from openacr.protocol.events import NEED_DATA, ControlKey
from openacr.protocol.parameter import GetLong

PLAIN, QUIET, NO_ECHO = EchoMode.CHARACTERS, EchoMode.NO_PROMPT, EchoMode(0)
REPLY = bytes.fromhex("00 88 00 30 E8 03 00 00")


def fed(session: Session, data: bytes, sizes: Iterable[int]) -> list[object]:
    """All events for the data in pieces of these sizes."""
    events: list[object] = []
    for size in sizes:
        piece, data = data[:size], data[size:]
        session.receive_data(piece)
        while (event := session.next_event()) is not NEED_DATA:
            events.append(event)
            if isinstance(event, Answer):
                break
    return events


def asked(request: Request, reply: bytes, echo: EchoMode = PLAIN, chunk: int = 1 << 16) -> object:
    session = Session(echo)
    session.begin(request)
    (answer,) = fed(session, reply, [chunk] * (len(reply) // chunk + 1))
    return answer


LINES = (
    (PLAIN, "?P12288", b"?P12288\r\n1000\r\nP00>", ("1000",)),
    (PLAIN, "X10", b"X10\r\nP00>", ()),
    (PLAIN, "", b"\r\nSYS>", ()),
    (PLAIN, "foo", b"foo\r\nUnknown command\r\nSYS>", ("Unknown command",)),
    (PLAIN, "PPU X Y", b"PPU X Y\r\n1000\r\n2000\r\nP15>", ("1000", "2000")),
    (PLAIN, 'PRINT ">"', b'PRINT ">"\r\n>\r\nPLC7>', (">",)),
    (PLAIN, "REM P00>", b"REM P00>\r\nP00>", ()),
    (NO_ECHO, "?1", b"1\r\nP03>", ("1",)),
    (NO_ECHO, "X1", b"P03>", ()),
    (QUIET, "?1", b"1\r\n=1=\r\n", ("1",)),
    (QUIET, "X1", b"=1=\r\n", ()),
    (QUIET, "foo", b"Unknown command\r\n=1=\r\n", ("Unknown command",)),
)


@pytest.mark.parametrize(("echo", "line", "reply", "output"), LINES)
@pytest.mark.parametrize("chunk", [1, 2, 3, 7, 1000])
def test_an_answer_is_the_same_in_pieces_of_any_size(
    echo: EchoMode, line: str, reply: bytes, output: tuple[str, ...], chunk: int
) -> None:
    assert asked(Line(line), reply, echo, chunk) == Answer(output)


@settings(max_examples=60, deadline=None)
@given(st.lists(st.integers(1, 9), min_size=40, max_size=40))
def test_text_and_packets_alternate_in_any_pieces(sizes: list[int]) -> None:
    session = Session()
    for request, reply, answer in (
        (Line("PROG1"), b"PROG1\r\nP01>", Answer()),
        (Ask((GetLong(12288),)), REPLY, Answer(data=REPLY[4:])),
        (Line("?2"), b"?2\r\n2\r\nP01>", Answer(("2",))),
    ):
        session.begin(request)
        assert fed(session, reply, [*sizes, 100]) == [answer]
    assert session.level == Level.program(1)


@pytest.mark.parametrize(
    ("prompt", "level"), [("SYS>", SYS), ("P15>", Level.program(15)), ("PLC3>", Level.plc(3))]
)
def test_prompts_tell_the_level(prompt: str, level: Level) -> None:
    session = Session()
    session.begin(Line(""))
    fed(session, b"\r\n" + prompt.encode(), [100])
    assert session.level == level
    assert Level.of_line(str(level).lower() + " ") == level


def test_without_prompts_the_lines_tell_the_level_unless_they_are_refused() -> None:
    session = Session(QUIET)
    assert session.begin(Line("PROG 2")) == b'PROG 2\rPRINT "=1="\r'
    fed(session, b"=1=\r\n", [100])
    assert session.level == Level.program(2)
    session.begin(Line("PROG 77"))
    fed(session, b"Invalid argument\r\n=2=\r\n", [100])
    assert session.level == Level.program(2)


def test_output_without_line_end_is_complete_only_after_silence() -> None:
    session = Session()
    session.begin(Line('PRINT "abc";'))
    session.receive_data(b'PRINT "abc";\r\nabcP00>')
    assert session.next_event() is NEED_DATA
    assert session.may_be_done
    assert session.end_of_data() == Answer(("abc",))


def test_a_listed_line_that_looks_like_a_prompt_does_not_end_the_listing() -> None:
    session = Session()
    session.begin(Line("LIST"))
    session.receive_data(b"LIST\r\n10 REM type P00>")
    assert session.next_event() is NEED_DATA
    session.receive_data(b"\r\n20 END\r\nP00>")
    assert session.next_event() == Answer(("10 REM type P00>", "20 END"))


@pytest.mark.parametrize("reply", [b"?1\x00\r\n1\r\nP00>", b"\r\nP00>?1\r\n1\r\nP00>"])
def test_a_wrong_echo_is_a_garbled_answer(reply: bytes) -> None:
    answer = asked(Line("?1"), reply)
    assert isinstance(answer, Answer)
    assert answer.is_garbled


def test_text_in_front_of_a_packet_reply_is_garbled_unless_a_program_is_followed() -> None:
    answer = asked(Ask((GetLong(12288),)), b"P00>" + REPLY)
    assert isinstance(answer, Answer)
    assert answer.is_garbled
    session = Session()
    session.begin(Follow("LISTEN"))
    assert fed(session, b"LISTEN\r\nab", [100]) == [Heard("ab")]
    session.begin(Ask((GetLong(12288),)))
    assert fed(session, b"cd\r\n" + REPLY + b"ef\r\n", [100]) == [Answer(data=REPLY[4:])]
    assert session.next_event() == Heard("cd\nef\n")


@pytest.mark.parametrize("chunk", [1, 3, 100])
def test_a_followed_program_is_heard_until_its_prompt(chunk: int) -> None:
    session = Session()
    assert session.begin(Follow("LRUN")) == b"LRUN\r"
    events = fed(session, b"LRUN\r\nPOSITION 1\r\nP2\r\nSYSTEM\r\nP04>", [chunk] * 50)
    heard = "".join(event.text for event in events if isinstance(event, Heard))
    assert heard == "POSITION 1\nP2\nSYSTEM\n"
    assert events[-1] == Answer()
    assert not session.is_listening
    assert session.level == Level.program(4)


def test_escape_ends_following_with_the_prompt() -> None:
    session = Session()
    session.begin(Follow("LISTEN"))
    fed(session, b"LISTEN\r\nfoo", [100])
    assert session.begin(Leave()) == b"\x1b"
    assert fed(session, b" bar\r\nP00>", [100])[-1] == Answer()
    assert not session.is_listening


def test_packets_travel_in_the_mode_of_a_serial_line() -> None:
    session = Session()
    session.mode = BinaryMode.PREFIX_CONTROLS
    assert session.begin(Ask((GetLong(4099),))) == bytes.fromhex("00 88 23 43 23 50")
    reply = bytes.fromhex("00 88 23 43 23 50") + b"#C#@#@#@"
    assert fed(session, reply, [1] * 20) == [Answer(data=b"\x03\0\0\0")]


def test_what_the_card_does_not_answer_is_done_at_once() -> None:
    session = Session()
    assert session.begin(Press(ControlKey.CTRL_X)) == b"\x18"
    assert session.next_event() == Answer()


@pytest.mark.parametrize(
    ("echo", "before", "reply"),
    [
        (PLAIN, b"garbage P0", b'\r\nP03>SYS\r\nSYS>ECHO 1\r\nSYS>PRINT "=1="\r\n=1=\r\nSYS>'),
        (PLAIN, b"", b'Unknown command\r\nPRINT "=1="\r\n=1=\r\nSYS>'),
        (QUIET, b"1\r\n", b"\r\nSYS\r\nSYS>ECHO 4\r\n=1=\r\n"),
        (NO_ECHO, b"", b"P00>SYS>SYS>=1=\r\nSYS>"),
    ],
)
def test_whatever_a_stream_was_doing_the_mark_tells_when_it_is_ours(
    echo: EchoMode, before: bytes, reply: bytes
) -> None:
    session = Session(echo)
    greeting = session.begin(Align())
    assert greeting == b'\x1b\rSYS\rECHO %d\rPRINT "=1="\r' % int(echo)
    assert fed(session, before + reply, [1] * 100) == [Answer()]
    assert session.level == SYS


@pytest.mark.parametrize("text", ["X1\rX2", "\x00", "a\x18", "\x1b", "\x7f"])
def test_lines_cannot_carry_keys_packets_or_a_second_line(text: str) -> None:
    with pytest.raises(UserError, match="cannot be part of a line"):
        Session().begin(Line(text))


def test_typographic_characters_travel_as_the_plain_ones() -> None:
    sent = Session().begin(Line("PRINT \u201cm\xb2\u201d : X\u22121"))
    assert sent == b'PRINT "m\xb2" : X-1\r'
    with pytest.raises(UserError, match="cannot be sent to a card"):
        Session().begin(Line("REM \u0416"))


@pytest.mark.parametrize("echo", [2, 3, 5, 6, 7])
def test_modes_that_hide_errors_or_mix_echo_and_output_are_not_used(echo: int) -> None:
    with pytest.raises(UserError, match="ECHO 1, 4 and 0"):
        Session(EchoMode(echo))
