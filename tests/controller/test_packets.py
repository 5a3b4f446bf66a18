"""Binary packets among the text of a terminal connection (terminal protocol, section 10)."""

import csv
import struct
from pathlib import Path

import pytest
from tests.controller.hosts import Host

from openacr.controller import Controller
from openacr.map.kinds_cy import is_read_only


@pytest.mark.req("BIN-047")
def test_text_and_packets_alternate_and_a_typed_line_goes_on(axes: Host) -> None:
    request = bytes.fromhex("00 88 00 30")
    assert axes.send("?P12") == "?P12"
    assert axes.raw(request) == request + bytes(4)
    assert axes.send("288\r") == "288|0|P00>"
    axes.card.receive(axes.stream, b"?1\r" + request + b"?2\r")
    writes = axes.writes()
    assert writes == ["?1|1|P00>", (request + bytes(4)).decode("latin-1"), "?2|2|P00>"]


def test_a_flag_set_by_a_packet_starts_a_home_search(axes: Host) -> None:
    number = 17160
    axes.raw(b"\x1c" + struct.pack("<H", number))
    axes.card.advance(200)
    assert axes.ask("?BIT792") == "-1"


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
