"""The binary move: header codes, field order, both meanings of header code 0, padding."""

import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from openacr.protocol import packets
from openacr.protocol.move import Move
from openacr.protocol.move_codes import Code1, Code3, Curve
from openacr.protocol.packets import PacketError


def words(*values: int | float) -> bytes:
    return b"".join(struct.pack("<i" if isinstance(v, int) else "<f", v) for v in values)


def decoded(data: bytes) -> Move:
    packet = packets.decode(data)
    assert isinstance(packet, Move)
    return packet


@pytest.mark.req("BIN-113", "BIN-114", "BIN-115", "BIN-122", "BIN-123", "BIN-134", "BIN-133")
def test_fields_come_in_the_documented_order() -> None:
    codes = bytes.fromhex("04 38 A0 05 9C 00 00 02 00")
    move = decoded(codes + words(10.0, 2.5, 200.0, 1.0, 2.0, 3.0, 4.0, 5.0, 0.5, 0.25))
    assert (move.vel, move.fvel, move.acc) == (10.0, 2.5, 200.0)
    assert move.targets == ((0, 1.0), (2, 2.0), (9, 3.0))
    assert move.centers == (4.0, 5.0)
    assert move.scaling == (0.5, 0.25)
    assert move.header.curve is Curve.ARC
    assert move.encode() == codes + words(10.0, 2.5, 200.0, 1.0, 2.0, 3.0, 4.0, 5.0, 0.5, 0.25)


@pytest.mark.req("BIN-128", "BIN-129", "BIN-154", "BIN-155", "BIN-156", "BIN-157")
def test_curves_use_the_arc_bits_for_themselves() -> None:
    nurb = Move.of({0: 1, 1: 2}, code1=Code1.NURB, code3=Code3.CURVE, scaling=(0.25, 1.0))
    spline = Move.of(
        {0: 1}, code1=Code1.SPLINE | Code1.SPLINE_KNOTS, code3=Code3.CURVE, scaling=(0.5, 0.0)
    )
    again = decoded(spline.encode())
    assert again.header.curve is Curve.SPLINE
    assert again.code1 & Code1.SPLINE_KNOTS
    assert (again.centers, again.scaling) == (None, (0.5, 0.0))
    assert decoded(nurb.encode()).header.curve is Curve.NURB


@given(
    targets=st.dictionaries(st.integers(0, 15), st.integers(-(2**31), 2**31 - 1), max_size=16),
    master=st.integers(0, 15),
    vel=st.none() | st.floats(width=32, allow_nan=False),
    fvel=st.none() | st.floats(width=32, allow_nan=False),
    centers=st.none() | st.tuples(st.integers(-9, 9), st.integers(-9, 9)),
    tolerance=st.none() | st.floats(width=32, allow_nan=False),
)
def test_moves_survive_the_wire(
    targets: dict[int, int],
    master: int,
    vel: float | None,
    fvel: float | None,
    centers: tuple[int, int] | None,
    tolerance: float | None,
) -> None:
    move = Move.of(targets, master=master, vel=vel, fvel=fvel, centers=centers, tolerance=tolerance)
    data = move.encode()
    assert decoded(data) == move
    for have in range(1, len(data)):
        assert have < packets.total_length(data[:have]) <= len(data)
    assert b"".join(part.data for part in move.explain()) == data


def test_a_path_tolerance_is_the_last_field_and_a_bit_that_cards_reserve() -> None:
    move = Move.of({0: 1}, tolerance=0.5)
    assert move.encode() == bytes.fromhex("04 08 00 01 80 00 01 00 00") + words(1, 0.5)
    assert Move.of({0: 1}).encode() == bytes.fromhex("04 00 00 01") + words(1)
    assert "path tolerance" in packets.explain(move.encode())


def test_fields_that_the_codes_do_not_announce_are_refused() -> None:
    with pytest.raises(PacketError, match="header codes"):
        Move(bytes(8), vel=1.0).encode()
    with pytest.raises(PacketError, match="both are 0"):
        Move.of({16: 1})
    for master in (-1, 16):
        with pytest.raises(PacketError, match=f"of master {master}: both are 0"):
            Move.of({0: 1}, master=master)
    assert Move.of({15: 1}, master=15).encode()
