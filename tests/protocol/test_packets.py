"""Every packet of the manual byte for byte, with its errata."""

from types import SimpleNamespace
from typing import Any, ClassVar

import pytest

from openacr.channels import ASCII_PORT, BINARY_PORT, BinaryMode
from openacr.protocol import packet as packet_module
from openacr.protocol import packets
from openacr.protocol.bits import ClearBit, SetBit
from openacr.protocol.data import DataRequest, locate
from openacr.protocol.execute import execute
from openacr.protocol.framing import PacketReader
from openacr.protocol.host import Host
from openacr.protocol.memory import (
    MaskMemory,
    Peek,
    Poke,
    VariableAddress,
    VariableKind,
)
from openacr.protocol.override import FeedrateOverride, RapidOverride
from openacr.protocol.packet import PACKETS, Packet
from openacr.protocol.packets import PacketError
from openacr.protocol.parameter import (
    GetIeee,
    GetLong,
    MaskParameter,
    ParameterAddress,
    SetIeee,
    SetLong,
)

EXAMPLES: list[tuple[str, Packet]] = [
    ("00 30 02 2C", DataRequest(0x30, 2, 0x2C)),
    ("00 88 00 30", GetLong(12288)),
    ("00 89 00 30 10 11 12 00", SetLong(12288, 0x00121110)),
    ("00 89 01 10 FE FF FF FF", SetLong(4097, -2)),
    ("00 8A 00 20", GetIeee(8192)),
    ("00 8B 00 20 00 00 00 3F", SetIeee(8192, 0.5)),
    ("00 90 00 03 00 50 40 00", Peek(0, 3, 0x405000)),
    (
        "00 91 00 03 00 50 40 00 10 11 12 13 20 21 22 23 30 31 32 33",
        Poke(0, 3, 0x405000, (0x13121110, 0x23222120, 0x33323130)),
    ),
    ("00 92 05 02", VariableAddress(5, VariableKind.SV)),
    ("00 93 00 30", ParameterAddress(12288)),
    (
        "00 94 00 00 43 60 40 00 FF FF FF FF 01 00 00 00",
        MaskMemory(0x406043, 0xFFFFFFFF, 1),
    ),
    ("00 95 01 10 FF FF FF FF 01 00 00 00", MaskParameter(4097, 0xFFFFFFFF, 1)),
    ("1C 08 02", SetBit(520)),
    ("1D 20 00", ClearBit(32)),
    ("07 08 00 00 00 00 00 3F", FeedrateOverride.of([3], 0.5)),
    ("1F 08 00 00 00 00 00 3F", RapidOverride.of([3], 0.5)),
    ("07 00 00 81 00 00 80 3F", FeedrateOverride.of([8, 15], 1.0)),
]


@pytest.mark.parametrize(("wire", "packet"), EXAMPLES, ids=[text for text, _ in EXAMPLES])
def test_the_length_is_known_before_the_packet_is_complete(wire: str, packet: Packet) -> None:
    data = bytes.fromhex(wire)
    for have in range(1, len(data)):
        assert have < packets.total_length(data[:have]) <= len(data)
    assert packets.total_length(data) == len(data)


@pytest.mark.parametrize(("wire", "packet"), EXAMPLES, ids=[text for text, _ in EXAMPLES])
def test_an_explanation_covers_every_byte_once(wire: str, packet: Packet) -> None:
    assert b"".join(part.data for part in packet.explain()).replace(b"\0", b"") == bytes.fromhex(
        wire
    ).replace(b"\0", b"")


def test_an_explanation_names_the_fields() -> None:
    text = packets.explain(bytes.fromhex("00 8B 00 20 00 00 00 3F"))
    assert text.splitlines() == [
        "00 8B                   header = SetIeee",
        "00 20                   parameter = 8192",
        "00 00 00 3F             value = 0.5",
    ]


@pytest.mark.parametrize(
    "parameter", [4097, 6146, 6290, 6659, 6980, 7312, 9999, 12290, 16128, 24580]
)
def test_locate_is_the_inverse_of_the_group_numbering(parameter: int) -> None:
    request = locate(parameter)
    assert request is not None
    assert list(request.parameters()) == [parameter]


def test_parameters_outside_all_groups_have_no_data_packet() -> None:
    assert locate(0) is None
    assert locate(28672) is None


def test_an_unknown_group_is_refused() -> None:
    with pytest.raises(PacketError, match="0x77"):
        DataRequest(0x77, 0, 1).parameters()


def test_a_packet_is_one_class_with_what_it_does(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(packet_module, "PACKETS", dict(PACKETS))

    @packet_module.register
    class Toggle(Packet, frozen=True):
        HEADER: ClassVar[bytes] = b"\x00\x96"
        bit: packet_module.U16

        def act(self, host: Host) -> bytes:
            host.write_bit(self.bit, True)
            return self.reply([self.bit])

    sent = bytes.fromhex("009608 02")
    assert packets.total_length(sent[:2]) == 4
    assert packets.decode(sent) == Toggle(520)
    assert packets.explain(sent).endswith("bit = 520")
    set_bits: list[tuple[int, bool]] = []
    host: Any = SimpleNamespace(write_bit=lambda number, on: set_bits.append((number, on)))
    assert execute(host, Toggle(520)) == sent + bytes.fromhex("08020000")
    assert set_bits == [(520, True)]


def test_a_packet_that_does_nothing_cannot_be_made() -> None:
    class Nothing(Packet, frozen=True):
        HEADER: ClassVar[bytes] = b"\x00\x97"

    with pytest.raises(TypeError, match="act"):
        Nothing()  # type: ignore[abstract]


def test_packets_say_which_parameters_and_flags_they_name() -> None:
    of = {type(packet): packet for _, packet in EXAMPLES}
    named = {kind: list(packet.parameters()) for kind, packet in of.items()}
    assert {kind: numbers for kind, numbers in named.items() if numbers} == {
        DataRequest: [12802, 13058, 13570],
        GetLong: [12288],
        SetLong: [4097],
        GetIeee: [8192],
        SetIeee: [8192],
        ParameterAddress: [12288],
        MaskParameter: [4097],
    }
    flags = {kind: list(packet.flags()) for kind, packet in of.items()}
    assert {kind: numbers for kind, numbers in flags.items() if numbers} == {
        SetBit: [520],
        ClearBit: [32],
    }


def test_only_set_and_clear_are_padded_on_a_dpcb() -> None:
    padded = {header for header in PACKETS if packets.dpcb_padding(header)}
    assert padded == {b"\x1c", b"\x1d"}
    assert packets.dpcb_padding(b"\x1c") == 1
    assert packets.dpcb_padding(b"\x05") == 0


@pytest.mark.parametrize(
    "packet", [SetLong(70000, 0), SetLong(1, 1 << 31), SetBit(-1), SetIeee(1, 1e60)]
)
def test_values_that_do_not_fit_are_refused(packet: Packet) -> None:
    with pytest.raises(PacketError):
        packet.encode()


def test_masters_beyond_15_are_refused() -> None:
    with pytest.raises(PacketError, match="master 16"):
        FeedrateOverride.of([16], 1.0)


@pytest.mark.parametrize("data", [b"", b"\x05", bytes(5), b"\x00\x88\x00"])
def test_bytes_that_are_no_packet_are_refused(data: bytes) -> None:
    with pytest.raises(PacketError):
        packets.decode(data)


def test_a_beginning_of_no_packet_is_forgotten() -> None:
    reader = PacketReader(dpcb=False, short_overrides=False)
    reader.start(0x01, BinaryMode.PLAIN, 0)
    with pytest.raises(PacketError, match="no packet starts with 01 00"):
        reader.feed(b"\0", 0)
    assert not reader.reading


def test_the_ports_are_those_hosts_connect_to() -> None:
    assert (ASCII_PORT, BINARY_PORT) == (5002, 5006)


@pytest.mark.parametrize(("wire", "packet"), EXAMPLES, ids=[text for text, _ in EXAMPLES])
def test_what_asks_for_parameters_is_known_by_its_four_bytes(wire: str, packet: Packet) -> None:
    data = bytes.fromhex(wire)
    is_asked = isinstance(packet, DataRequest | GetLong | GetIeee | ParameterAddress)
    assert packets.request(data[:4]) == (packet if is_asked else None)
    assert packets.request(data[:3]) is None
    assert packet.encode() == data
