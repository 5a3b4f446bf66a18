"""The binary move: header codes, field order, both meanings of header code 0, padding."""

import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from openacr.protocol import packets
from openacr.protocol.move import Move, unpadded
from openacr.protocol.move_codes import Code0, Code1, Code3, Curve, Profile
from openacr.protocol.packets import PacketError


def words(*values: int | float) -> bytes:
    return b"".join(struct.pack("<i" if isinstance(v, int) else "<f", v) for v in values)


def decoded(data: bytes) -> Move:
    packet = packets.decode(data)
    assert isinstance(packet, Move)
    return packet


@pytest.mark.req("BIN-109", "BIN-112")
def test_the_shortest_move_has_four_header_bytes() -> None:
    move = decoded(bytes.fromhex("04 00 00 01") + words(1000))
    assert move.targets == ((0, 1000),)
    assert (move.master, move.curve, move.vel, move.fvel, move.acc) == (0, Curve.LINE, *3 * [None])


@pytest.mark.req("BIN-110", "BIN-111", "BIN-112", "BIN-130", "BIN-138")
def test_codes_3_to_7_are_announced_by_bits() -> None:
    five = decoded(bytes.fromhex("04 08 00 80 04") + words(1.5))
    assert five.targets == ((7, 1.5),)
    nine = decoded(bytes.fromhex("04 08 02 00 80 08 00 81 00") + words(1, 2))
    assert nine.targets == ((8, 1), (15, 2))
    assert nine.master == 10


@pytest.mark.req("BIN-113", "BIN-114", "BIN-115", "BIN-122", "BIN-123", "BIN-134", "BIN-133")
def test_fields_come_in_the_documented_order() -> None:
    codes = bytes.fromhex("04 38 A0 05 9C 00 00 02 00")
    move = decoded(codes + words(10.0, 2.5, 200.0, 1.0, 2.0, 3.0, 4.0, 5.0, 0.5, 0.25))
    assert (move.vel, move.fvel, move.acc) == (10.0, 2.5, 200.0)
    assert move.targets == ((0, 1.0), (2, 2.0), (9, 3.0))
    assert move.centers == (4.0, 5.0)
    assert move.scaling == (0.5, 0.25)
    assert move.curve is Curve.ARC
    assert move.encode() == codes + words(10.0, 2.5, 200.0, 1.0, 2.0, 3.0, 4.0, 5.0, 0.5, 0.25)


@pytest.mark.req("BIN-115")
def test_positions_are_integers_unless_marked_floating() -> None:
    assert decoded(bytes.fromhex("04 08 00 01 00") + words(-5)).targets == ((0, -5),)
    assert decoded(bytes.fromhex("04 08 00 01 04") + words(-5.5)).targets == ((0, -5.5),)
    for code3, values in ((0, (-5, 7, -100_000, 3)), (4, (-5.5, 7.25, -0.5, 3.0))):
        arc = decoded(bytes((4, 8, 0x20, 3, code3)) + words(*values))
        assert arc.targets == ((0, values[0]), (1, values[1]))
        assert (arc.curve, arc.centers) == (Curve.ARC, values[2:])
        for code1, curve in ((0x40, Curve.NURB), (0x80, Curve.SPLINE)):
            point = decoded(bytes((4, 8, code1, 3, 0x40 | code3)) + words(*values[:2]))
            assert (point.curve, point.targets) == (curve, arc.targets)


@pytest.mark.req("BIN-125", "BIN-137")
@pytest.mark.parametrize("master", range(16))
def test_the_master_has_three_low_bits_and_one_high_bit(master: int) -> None:
    move = Move.of({0: 1}, master=master)
    assert decoded(move.encode()).master == master
    assert (len(move.encode()) == 13) == (master > 7)


@pytest.mark.req("BIN-117", "BIN-118", "BIN-119")
@pytest.mark.parametrize(
    ("code0", "profile"),
    [
        (0, Profile(False, False, False, False)),
        (Code0.FVEL_LOCKOUT, Profile(False, True, False, False)),
        (Code0.OVERRIDE_LOCKOUT, Profile(False, False, False, True)),
        (Code0.STP_RAMP, Profile(True, False, False, False)),
        (7, Profile(True, True, False, True)),
    ],
)
def test_header_code_0_by_default(code0: int, profile: Profile) -> None:
    assert Move.of({0: 1}, code0=code0).profile(rapid_move_modes=False) == profile


@pytest.mark.req("BIN-120", "BIN-139", "BIN-140", "BIN-141", "BIN-142")
@pytest.mark.parametrize(
    ("code0", "profile"),
    [
        (0b000, Profile(False, False, False, False)),  # feed continuous
        (0b100, Profile(True, False, False, False)),  # feed cornering
        (0b001, Profile(True, True, False, False)),  # feed stopping
        (0b101, Profile(True, True, True, False)),  # rapid
        (0b111, Profile(True, True, True, True)),
    ],
)
def test_header_code_0_with_rapid_move_modes(code0: int, profile: Profile) -> None:
    assert Move.of({0: 1}, code0=code0).profile(rapid_move_modes=True) == profile


@pytest.mark.req("BIN-124")
def test_the_move_counter_counts_as_set() -> None:
    down = Code0.COUNTER | Code0.COUNT_DOWN
    steps = [Move.of({0: 1}, code0=code).counter_step for code in (0, 0x40, 0x80, down)]
    assert steps == [0, 0, 1, -1]


@pytest.mark.req("BIN-145", "BIN-146", "BIN-147", "BIN-148")
def test_the_arc_plane_names_two_of_the_first_three_slaves() -> None:
    arcs = [Move.of({0: 1}, code1=plane << 6, centers=(1, 2)) for plane in range(4)]
    assert [arc.arc_slaves for arc in arcs[:3]] == [(0, 1), (1, 2), (2, 0)]
    with pytest.raises(PacketError, match="plane 3"):
        _ = arcs[3].arc_slaves


@pytest.mark.req("BIN-128", "BIN-129", "BIN-154", "BIN-155", "BIN-156", "BIN-157")
def test_curves_use_the_arc_bits_for_themselves() -> None:
    nurb = Move.of({0: 1, 1: 2}, code1=Code1.NURB, code3=Code3.CURVE, scaling=(0.25, 1.0))
    spline = Move.of(
        {0: 1}, code1=Code1.SPLINE | Code1.SPLINE_KNOTS, code3=Code3.CURVE, scaling=(0.5, 0.0)
    )
    again = decoded(spline.encode())
    assert again.curve is Curve.SPLINE
    assert again.code1 & Code1.SPLINE_KNOTS
    assert (again.centers, again.scaling) == (None, (0.5, 0.0))
    assert decoded(nurb.encode()).curve is Curve.NURB


@pytest.mark.req("BIN-126", "BIN-135", "BIN-136")
def test_single_bits_keep_their_places() -> None:
    assert (Code1.INTERRUPT, Code1.COUNTERCLOCKWISE) == (0x08, 0x10)
    assert (Code3.INCREMENTAL_TARGET, Code3.INCREMENTAL_CENTER) == (0x01, 0x02)
    assert (Code3.BLOCK_SKIP, Code3.CURVE) == (0x20, 0x40)


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


@pytest.mark.req("BIN-112")
def test_a_header_padded_to_eight_is_recognized_by_length() -> None:
    documented = bytes.fromhex("04 08 00 01 04") + words(2.5)
    padded = documented[:5] + bytes(3) + documented[5:]
    assert unpadded(padded) == documented
    assert unpadded(documented) is None
    assert unpadded(padded + b"\r") is None
    assert unpadded(documented[:5] + b"\0\1\0" + documented[5:]) is None


def test_fields_that_the_codes_do_not_announce_are_refused() -> None:
    with pytest.raises(PacketError, match="header codes"):
        Move(bytes(8), vel=1.0).encode()
    with pytest.raises(PacketError, match="both are 0"):
        Move.of({16: 1})
    for master in (-1, 16):
        with pytest.raises(PacketError, match=f"of master {master}: both are 0"):
            Move.of({0: 1}, master=master)
    assert Move.of({15: 1}, master=15).encode()
