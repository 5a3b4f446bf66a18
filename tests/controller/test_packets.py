"""Binary packets among the text of a terminal connection (terminal protocol, section 10)."""

import struct

from tests.controller.hosts import Host


def test_a_flag_set_by_a_packet_starts_a_home_search(axes: Host) -> None:
    number = 17160
    axes.raw(b"\x1c" + struct.pack("<H", number))
    axes.card.advance(200)
    assert axes.ask("?BIT792") == "-1"
