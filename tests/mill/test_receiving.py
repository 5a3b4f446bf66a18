"""LINK: part programs that arrive over a serial line are kept whole, or not at all."""

import pytest
from tests.mill.sender import Sender
from tests.mill.shop import Shop

from openacr.errors import UserError
from openacr.mill.config.communications import Line
from openacr.mill.run.handshake import XOFF, XON
from openacr.mill.run.receiving import ArrivingFile, Patience, Reception

SHORT = Patience(first_s=0.2, after_end_s=0.2, amid_s=0.4)
NEVER = Patience(first_s=1e6, after_end_s=1e6, amid_s=1e6)


def reception(
    sender: Sender, patience: Patience = NEVER, most_bytes: int = 1000, **cells: float
) -> Reception:
    shop = Shop(**cells)
    return Reception(Line.of(shop.store, sender.port), patience, most_bytes)


@pytest.mark.req("MILL-LOAD-LINK")
@pytest.mark.parametrize(
    ("sent", "kept"),
    [
        (b"G90 F600\r\nG1 X1\r\nM2\r\n\x1a\x1a", b"G90 F600\nG1 X1\nM2\n"),
        (b"G1 X1\x1aG1 X2\n", b"G1 X1\n"),
        (b"\0\0\x12%\n\r\rO12\n\r\rM30\n\r\r%\x14\0\0", b"%\nO12\nM30\n%\n"),
        (b"\r\n  %PLATE\r\nM2\r\n % rest", b"  %PLATE\nM2\n %\n"),
        (b"G1 X1\rM2\r%", b"G1 X1\nM2\n%\n"),
        (b"PRINT 10%2\nM99\n%\n", b"PRINT 10%2\nM99\n%\n"),
    ],
)
def test_a_program_ends_with_control_z_or_the_second_percent(
    sender: Sender, sent: bytes, kept: bytes
) -> None:
    arriving = reception(sender)
    sender.send(sent)
    assert arriving.run() == kept


@pytest.mark.parametrize("last", [b"M2\r\n", b"N90 m30", b"M02 (END)\n\n", b"(M5)M99\n"])
def test_silence_ends_a_program_after_a_block_that_ends_one(sender: Sender, last: bytes) -> None:
    arriving = reception(sender, SHORT)
    sender.send(b"G1 X1\n" + last)
    assert arriving.run() == b"G1 X1\n" + last.replace(b"\r", b"").strip() + b"\n"


@pytest.mark.parametrize(
    ("sent", "why"),
    [
        (b"", "nothing was received (silent for 0.2 s)"),
        (b"G1 X1\nG1 X2\n", "the sender stopped after line 2, before %, Ctrl-Z, M2, M30 or M99"
         " (silent for 0.4 s)"),
        (b"G1 X", "the sender stopped after the first line, before %, Ctrl-Z, M2, M30 or M99"
         " (silent for 0.4 s)"),
        (b"%\nM30\n", "the sender stopped after line 2, before the closing % (silent for 0.4 s)"),
        (b"G1 X1\nM20\n", "the sender stopped after line 2, before %, Ctrl-Z, M2, M30 or M99"
         " (silent for 0.4 s)"),
        (b"G1 X1\n(M2)\n", "the sender stopped after line 2, before %, Ctrl-Z, M2, M30 or M99"
         " (silent for 0.4 s)"),
        (b"%\n%\n", "the program is empty"),
        (b"\x1a", "the program is empty"),
        (b"G1 X1\n\x05\n", "byte 0x05 is no text: baud rate, data bits and parity must be those"
         " of the sender"),
        (b"X1\n" * 34, "the program is longer than 100 bytes"),
    ],
)  # fmt: skip
def test_what_is_not_a_whole_program_is_refused(sender: Sender, sent: bytes, why: str) -> None:
    arriving = reception(sender, SHORT, most_bytes=100)
    sender.send(sent)
    with pytest.raises(UserError) as refusal:
        arriving.run()
    assert str(refusal.value) == f"{sender.port}: {why}"


def test_a_sender_may_pause_again_and_again_for_less_than_the_limit(sender: Sender) -> None:
    arriving = reception(sender, SHORT)
    sender.send(b"G1 X1\n")
    later = {5: b"G1 X2\n", 9: b"\x1a"}  # after three silent polls each; the fourth is the limit
    polls = 0

    def send_later() -> bool:
        nonlocal polls
        polls += 1
        sender.send(later.get(polls, b""))
        return False

    assert arriving.run(send_later) == b"G1 X1\nG1 X2\n"


def test_as_many_bytes_as_are_allowed_are_kept(sender: Sender) -> None:
    arriving = reception(sender, most_bytes=100)
    sender.send(b"%\n" + b"X12\n" * 24 + b"\n%")
    program = arriving.run()
    assert program is not None
    assert len(program) == 101  # with the end of the last line


def test_bytes_and_lines_are_counted_while_they_arrive_in_pieces() -> None:
    arriving = ArrivingFile()
    counts = []
    for piece in (b"\n", b"%", b"\r", b"\nG1", b" X1\r\n", b"10%2\r", b"\n %", b"X"):
        arriving.add(piece)
        counts.append((arriving.bytes_cnt, arriving.lines_cnt, arriving.is_complete))
    assert counts == [
        (1, 1, False), (2, 1, False), (3, 1, False), (6, 2, False), (11, 3, False),
        (16, 3, False), (19, 4, True), (19, 4, True),
    ]  # fmt: skip
    assert arriving.program.endswith(b"10%2\n %\n")


def test_the_sender_is_released_at_the_beginning_and_stopped_by_a_cancel(sender: Sender) -> None:
    arriving = reception(sender, P750_005=1)
    assert sender.listen() == b""
    assert arriving.run(is_cancelled=lambda: sender.listen() == XON) is None
    assert sender.hears(XON + XOFF)


def test_a_sender_is_stopped_when_its_program_is_refused(sender: Sender) -> None:
    arriving = reception(sender, most_bytes=4, P750_005=1)
    sender.send(b"G1 X1\n")
    with pytest.raises(UserError, match="longer than 4 bytes"):
        arriving.run()
    assert sender.hears(XON + XOFF)


def test_without_the_handshake_nothing_is_sent(sender: Sender) -> None:
    arriving = reception(sender, P750_005=0)
    sender.send(b"M2\n\x1a")
    assert arriving.run() == b"M2\n"
    assert sender.listen() == b""


def test_a_port_has_one_reader_and_is_free_after_it(sender: Sender) -> None:
    first = reception(sender)
    with pytest.raises(UserError) as refusal:
        reception(sender)
    assert str(refusal.value) == f"cannot open serial port {sender.port}: it is in use"
    sender.send(b"M2\n\x1a")
    first.run()
    assert reception(sender, SHORT).run(lambda: True) is None


def test_a_port_that_fails_in_the_middle_is_named(sender: Sender) -> None:
    arriving = reception(sender)
    sender.send(b"G1 X1\n")
    sender.hang_up()
    with pytest.raises(UserError, match=f"^{sender.port} failed: "):
        arriving.run()
