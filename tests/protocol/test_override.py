"""FOV and ROV: which masters they select, which values they may have, and six-byte forms."""

import struct
from collections.abc import Iterator

import pytest

from openacr.channels import BinaryMode, StreamKind
from openacr.protocol.escape import encode_packet
from openacr.protocol.events import NEED_DATA, Event, Received, ReceivedLine
from openacr.protocol.override import (
    FeedrateOverride,
    RapidOverride,
    belongs_to_next,
    is_override,
    is_short,
    lengthened,
)
from openacr.protocol.packets import PacketError
from openacr.protocol.parameter import GetLong
from openacr.protocol.terminal import Terminal

SHORT = bytes.fromhex("07 08 00 00 00 3F")  # FOV 0.5 of master 3, as the first edition prints it
GET = bytes.fromhex("00 88 00 30")


def events(data: bytes, chunk: int, terminal: Terminal) -> Iterator[Event]:
    for at in range(0, len(data), chunk):
        terminal.receive_data(data[at : at + chunk], 0)
        while (event := terminal.next_event()) is not NEED_DATA:
            assert not isinstance(event, type(NEED_DATA))
            yield event


@pytest.mark.parametrize("kind", [FeedrateOverride, RapidOverride])
@pytest.mark.parametrize(
    ("masters", "short_mask", "long_mask"),
    [
        ([0], 0x01, 0),
        ([7], 0x80, 0),
        ([0, 7], 0x81, 0),
        ([8], 0, 0x0100),
        ([15], 0, 0x8000),
        ([7, 8], 0, 0x0180),
        (range(8), 0xFF, 0),
        (range(16), 0, 0xFFFF),
    ],
)
def test_masters_are_in_the_short_mask_as_far_as_it_reaches(
    kind: type[FeedrateOverride | RapidOverride],
    masters: list[int],
    short_mask: int,
    long_mask: int,
) -> None:
    packet = kind.of(masters, 0.5)
    assert packet.encode() == (
        kind.HEADER + bytes((short_mask,)) + struct.pack("<Hf", long_mask, 0.5)
    )
    assert packet.masters() == list(masters)


def test_both_masks_select_masters() -> None:
    assert FeedrateOverride(0x01, 0x8000, 1.0).masters() == [0, 15]
    assert FeedrateOverride(0x01, 0x0001, 1.0).masters() == [0]


@pytest.mark.parametrize("master", [-1, 16])
def test_a_master_a_card_does_not_have_is_an_error(master: int) -> None:
    with pytest.raises(PacketError, match=rf"master {master} is not in 0\.\.15"):
        FeedrateOverride.of([0, master], 0.5)


def test_packets_of_the_first_edition_are_short_where_a_mask_is_in_byte_1() -> None:
    assert is_short(SHORT)
    assert is_short(bytes.fromhex("1F 01"))
    assert not is_short(bytes.fromhex("07 00"))
    assert not is_short(bytes.fromhex("1C 08"))
    assert lengthened(SHORT) == bytes.fromhex("07 08 00 00 00 00 00 3F")


@pytest.mark.parametrize("value", [0.0, -0.0, 1e-4, 0.5, 1.0, 2.5, 1e4])
def test_an_override_is_zero_or_a_ratio_a_machine_can_follow(value: float) -> None:
    assert is_override(value)


@pytest.mark.parametrize(
    "value", [-1.0, -1e-38, 9.9e-5, 1.0001e4, float("inf"), -float("inf"), float("nan")]
)
def test_anything_else_is_no_override(value: float) -> None:
    assert not is_override(value)
    packet = FeedrateOverride(1, 0, value).encode()
    assert belongs_to_next(packet) is not None


def test_what_a_six_byte_override_has_swallowed_is_known() -> None:
    assert belongs_to_next(SHORT + GET[:2]) == GET[:2]
    assert belongs_to_next(FeedrateOverride(1, 0, 0.5).encode()) is None
    assert belongs_to_next(FeedrateOverride(0, 1, -0.5).encode()) == b""  # never six bytes
    assert belongs_to_next(bytes.fromhex("07 01 00 80 00 BF 00 BF")) == b""  # not six either


@pytest.mark.parametrize("mode", [BinaryMode.PLAIN, BinaryMode.PREFIX_CONTROLS, BinaryMode(3)])
@pytest.mark.parametrize("chunk", [1, 2, 3, 6, 7, 1000])
def test_the_packet_after_a_six_byte_override_is_read_and_the_override_refused(
    chunk: int, mode: BinaryMode, caplog: pytest.LogCaptureFixture
) -> None:
    terminal = Terminal(StreamKind.TERMINAL, timeout_tk=100)
    terminal.mode = mode
    data = b"".join(encode_packet(each, mode) for each in (SHORT, GET, SHORT, GET, GET))
    assert list(events(data, chunk, terminal)) == [Received(GetLong(0x3000))] * 3
    assert terminal.waiting_characters == 0
    misread = struct.unpack("<f", SHORT[4:] + GET[:2])[0]
    assert misread < 0
    assert [record.message for record in caplog.records] == [
        f"an override of {misread:g} was refused: a host that sends FOV and ROV in six bytes needs"
        " short_override_packets = true in machine.toml"
    ]


@pytest.mark.parametrize("group", [0x10, 0x1B, 0x20, 0x30, 0x38, 0x88, 0x8A, 0x90, 0x94])
def test_whatever_packet_follows_a_six_byte_override_is_no_value(group: int) -> None:
    assert belongs_to_next(SHORT + bytes((0, group))) == bytes((0, group))


@pytest.mark.parametrize("line", [b"?P0\r", b"X10\r", b"SYS\r"])
def test_a_line_after_a_six_byte_override_is_whole(line: bytes) -> None:
    terminal = Terminal(StreamKind.TERMINAL, timeout_tk=100)
    assert list(events(SHORT + line, 1000, terminal)) == [ReceivedLine(line[:-1].decode())]


def test_a_negative_override_of_eight_bytes_is_dropped_whole() -> None:
    terminal = Terminal(StreamKind.TERMINAL, timeout_tk=100)
    broken = FeedrateOverride(0, 1, -1.0).encode()
    assert list(events(broken + GET, 1000, terminal)) == [Received(GetLong(0x3000))]


def test_a_card_set_to_six_bytes_refuses_negative_values_and_reads_on() -> None:
    terminal = Terminal(StreamKind.TERMINAL, timeout_tk=100, short_overrides=True)
    negative = bytes.fromhex("07 08 00 00 00 BF")
    assert list(events(negative + GET + SHORT, 1000, terminal)) == [
        Received(GetLong(0x3000)),
        Received(FeedrateOverride(8, 0, 0.5)),
    ]
