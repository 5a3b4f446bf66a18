"""Binary packets among the text of a terminal connection (terminal protocol, section 10)."""

import csv
import struct
from pathlib import Path

import pytest
from msgspec.structs import replace
from tests.controller.hosts import Host, connected

from openacr.channels import StreamKind
from openacr.controller import Controller
from openacr.map.kinds_cy import is_read_only
from openacr.map.numbers import (
    MA_BASE,
    MA_FEEDRATE_OVERRIDE,
    MA_RAPID_FEEDRATE_OVERRIDE,
    MA_STRIDE,
)
from openacr.models import ACR9040
from openacr.plant.schema import default_world

FOV, ROV = MA_BASE + MA_FEEDRATE_OVERRIDE, MA_BASE + MA_RAPID_FEEDRATE_OVERRIDE


def test_a_reply_is_one_write_without_echo_or_prompt(axes: Host) -> None:
    axes.card.p[12290 + 256] = 0x23222120
    request = bytes.fromhex("00 30 02 03")
    assert axes.raw(request) == request + struct.pack("<2i", axes.card.p[12290], 0x23222120)


@pytest.mark.req("BIN-049")
def test_the_group_of_flag_words_gives_their_values(axes: Host) -> None:
    axes.card.bit[32], axes.card.bit[63] = True, True  # both ends of P4097
    words = [axes.card.p[4096 + k] for k in range(8)]
    assert words[1] == -(2**31) + 1
    for mask in (0x01, 0x02, 0x82, 0xFF):
        request = bytes((0, 0x10, 0, mask))
        wanted = [word for k, word in enumerate(words) if mask >> k & 1]
        assert axes.raw(request) == request + struct.pack(f"<{len(wanted)}i", *wanted)
    request = bytes.fromhex("00 10 01 01")
    assert axes.raw(request) == request + struct.pack("<i", axes.card.p[4104])


@pytest.mark.req("BIN-062")
def test_the_group_of_masters_gives_distance_and_move_counter(axes: Host) -> None:
    axes.type("X10")
    axes.card.advance(200)
    counter, distance = (bytes.fromhex(f"00 20 {index} 01") for index in ("10", "00"))
    into = axes.card.p[8192]
    assert 0.0 < into < 10.0
    assert axes.raw(distance) == distance + struct.pack("<f", into)
    axes.card.p[8208] = 41
    assert axes.raw(counter) == counter + struct.pack("<i", 41)


@pytest.mark.req("BIN-047")
def test_text_and_packets_alternate_and_a_typed_line_goes_on(axes: Host) -> None:
    request = bytes.fromhex("00 88 00 30")
    assert axes.send("?P12") == "?P12"
    assert axes.raw(request) == request + bytes(4)
    assert axes.send("288\r") == "288|0|P00>"
    axes.card.receive(axes.stream, b"?1\r" + request + b"?2\r")
    writes = axes.writes()
    assert writes == ["?1|1|P00>", (request + bytes(4)).decode("latin-1"), "?2|2|P00>"]


@pytest.mark.req("BIN-039")
def test_packets_are_answered_while_lines_wait(axes: Host) -> None:
    axes.send("DWL 1\r?1\r")
    request = bytes.fromhex("00 88 00 30")
    assert axes.raw(request) == request + bytes(4)
    axes.raw(bytes.fromhex("1C 20 00"))
    assert axes.card.bit[32]


@pytest.mark.req("BIN-159", "BIN-166", "BIN-172")
@pytest.mark.parametrize(
    ("packet", "row", "value"),
    [
        ("00 89 01 10 05 00 00 00", 4097, 5),
        ("1C 20 00", 4097, 1),
        ("1C 20 00 00", 4097, 1),
        ("00 95 01 10 00 00 00 00 06 00 00 00", 4097, 6),
        ("07 01 00 00 00 00 00 3F", FOV, 0.5),
        ("1F 01 00 00 00 00 00 3F", ROV, 0.5),
    ],
)
def test_packets_that_set_something_have_no_reply_and_act_at_once(
    axes: Host, packet: str, row: int, value: float
) -> None:
    axes.send("DWL 1\rVEL 5\r")
    assert axes.card.p[row] != value
    assert axes.raw(bytes.fromhex(packet)) == b""
    assert axes.card.p[row] == value
    axes.after(3000)
    assert axes.ask("?1") == "1"


def overridden(*, is_short: bool, packet: str) -> dict[int, float]:
    """The overrides of masters 0 to 8 that are not 1 any more after a packet."""
    world = default_world(ACR9040)
    card = replace(world.card, short_override_packets=is_short)
    host = connected(model="ACR9040", world=replace(world, card=card))
    assert host.raw(bytes.fromhex(packet)) == b""
    return {m: host.card.p[at(m)] for m in range(9) if host.card.p[at(m)] != 1.0}


def at(master: int) -> int:
    return FOV + MA_STRIDE * master


@pytest.mark.req("BIN-169")
def test_a_card_takes_six_byte_overrides_or_eight_byte_ones() -> None:
    six, eight = "07 08 00 00 00 3F", "07 08 00 00 00 00 00 3F"
    high = "07 00 00 01 00 00 00 3F"  # after a zero both forms have eight bytes
    assert overridden(is_short=True, packet=six) == {3: 0.5}
    assert overridden(is_short=False, packet=six) == {}
    assert overridden(is_short=False, packet=eight) == {3: 0.5}
    assert overridden(is_short=True, packet=eight) != {3: 0.5}
    assert overridden(is_short=True, packet=high) == {8: 0.5}
    assert overridden(is_short=False, packet=high) == {8: 0.5}
    both = "07 05 6D E7 FB 3D 1F 02 00 00 00 3F 00 88 00 30"
    world = default_world()
    card = replace(world.card, short_override_packets=True)
    host = connected(world=replace(world, card=card))
    assert host.raw(bytes.fromhex(both)) == bytes.fromhex("00 88 00 30 00 00 00 00")
    assert [host.card.p[at(m)] for m in range(3)] == pytest.approx([0.123, 1.0, 0.123])
    assert host.card.p[ROV + 256] == 0.5


def test_set_and_clear_change_a_flag(axes: Host) -> None:
    axes.raw(bytes.fromhex("1C 08 02"))
    assert axes.card.bit[520]
    axes.raw(bytes.fromhex("1D 08 02"))
    assert not axes.card.bit[520]


@pytest.mark.req("BIN-003", "BIN-004", "BIN-005")
def test_a_pause_of_50_ms_drops_an_incomplete_packet(axes: Host) -> None:
    assert axes.raw(bytes.fromhex("00 89 01 10 05 00")) == b""
    axes.card.advance(90)
    axes.raw(bytes.fromhex("00 00"))
    assert axes.card.p[4097] == 5
    assert axes.raw(bytes.fromhex("00 89 01 10 07 00")) == b""
    axes.card.advance(110)
    assert axes.send("?P4097\r") == "?P4097|5|P00>"


@pytest.mark.req("BIN-006")
@pytest.mark.parametrize("time_ms", [5, 200])
def test_the_longest_gap_is_a_parameter_of_the_channel(axes: Host, time_ms: int) -> None:
    axes.type("P7012=" + str(time_ms))
    serial, network = Host(axes.card, StreamKind.SERIAL), Host(axes.card)
    for gap_ms, taken in ((time_ms - 1, True), (time_ms + 1, False)):
        serial.raw(bytes.fromhex("1C 20"))
        axes.card.advance(2 * gap_ms)
        serial.raw(bytes.fromhex("23 40"))
        assert axes.card.bit[32] is taken
        axes.card.bit[32] = False
    network.raw(bytes.fromhex("1C 20"))
    axes.card.advance(80)
    network.raw(bytes.fromhex("00"))
    assert axes.card.bit[32]


def test_a_flag_set_by_a_packet_starts_a_home_search(axes: Host) -> None:
    number = 17160
    axes.raw(b"\x1c" + struct.pack("<H", number))
    axes.card.advance(200)
    assert axes.ask("?BIT792") == "-1"


def test_mode_3_prefixes_packets_on_the_stream_that_asked_for_it(axes: Host) -> None:
    other = Host(axes.card)
    axes.send("P4097=-1\r")
    assert axes.type("MODE 3") == "P00>"
    plain, prefixed = bytes.fromhex("00 88 01 10"), bytes.fromhex("00 26 23 48 23 41 23 50")
    assert axes.raw(prefixed) == prefixed + b"&#?" * 4
    assert other.raw(plain) == plain + b"\xff" * 4


@pytest.mark.req("BIN-012", "BIN-013")
@pytest.mark.parametrize(
    ("kind", "prefixes"),
    [(StreamKind.TERMINAL, False), (StreamKind.PACKETS, False), (StreamKind.SERIAL, True)],
)
def test_streams_start_in_their_mode(axes: Host, kind: StreamKind, prefixes: bool) -> None:
    host = Host(axes.card, kind)
    request = bytes.fromhex("00 88 23 41 23 50" if prefixes else "00 88 01 10")
    assert host.raw(request) != b""


def test_what_does_not_exist_reads_zero_and_keeps_the_host_in_step(axes: Host) -> None:
    for request in ("00 88 FF FF", "00 8A FF FF"):
        data = bytes.fromhex(request)
        assert axes.raw(data) == data + bytes(4)


GROUPS = Path(__file__).parents[1] / "data" / "binary-groups.csv"


@pytest.mark.req("BIN-050", "BIN-051", "BIN-052", "BIN-053", "BIN-059")
def test_every_documented_group_reads_the_parameters_it_names() -> None:
    card = Controller("ACR8020")
    host = Host(card)
    for row in csv.DictReader(GROUPS.read_text("utf-8").splitlines()):
        first, stride, count = int(row["first_parameter"]), int(row["stride"]), int(row["count"])
        fields = [first + stride * n for n in range(count)]
        for n, number in enumerate(fields):
            if is_read_only(number):
                card.memory.I[number] = 3 * n + 1
            else:
                card.memory.write(number, 3 * n + 1)
        mask = (1 << count) - 1
        request = bytes((0, int(row["code"], 16), int(row["group_index"], 16), mask))
        form = f"<{count}{'i' if row['type'] == 'LONG' else 'f'}"
        reply = host.raw(request)
        assert reply[:4] == request
        assert list(struct.unpack(form, reply[4:])) == [card.p[number] for number in fields], row
