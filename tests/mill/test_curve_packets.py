"""Control points as packets, byte by byte as the manual lays NURBs out."""

import struct

import pytest
from tests.mill.planned import planned_shop

from openacr.mill.config.settings import Settings
from openacr.mill.plan.curves.curve_packets import CurvePackets
from openacr.protocol.move import Move

HEADER, MASTER_0_NURB, X_Y_Z = 0x04, 0x40, 0x07
CODE_3, LOCKED, COUNTER, ACC = 0x08, 0x02, 0x80, 0x20
SCALING, FLOAT, CURVE = 0x08, 0x04, 0x40


def packets() -> CurvePackets:
    return CurvePackets(Settings(planned_shop().store))


def test_a_point_off_the_pulses_is_sent_in_units_with_knot_and_weight() -> None:
    many = packets()
    for _ in range(6):
        many.point([0.0, 0.0, 0.0], 100.0)
    data = many.point([1.23456, -2.5, 0.1], 100.0).encode()
    assert data == bytes(
        (HEADER, CODE_3 | LOCKED | COUNTER, MASTER_0_NURB, X_Y_Z, SCALING | FLOAT | CURVE)
    ) + struct.pack("<fffff", 1.23456, -2.5, 0.1, 6.0, 1.0)
    assert len(data) == 25


def test_a_point_on_the_pulses_is_sent_in_pulses() -> None:
    data = packets().point([1.2345, -2.5, 0.0], 100.0).encode()
    assert data == bytes(
        (HEADER, CODE_3 | LOCKED | ACC, MASTER_0_NURB, X_Y_Z, SCALING | CURVE)
    ) + struct.pack("<fiiiff", 100.0, 12345, -25000, 0, 0.0, 1.0)


def test_the_end_is_a_negative_knot_and_the_next_curve_begins_at_0() -> None:
    many = packets()
    for _ in range(9):
        many.point([0.0, 0.0, 0.0], 100.0)
    codes = (HEADER, CODE_3 | LOCKED | COUNTER, MASTER_0_NURB, 0, SCALING | CURVE)
    assert many.end().encode() == bytes(codes) + struct.pack("<ff", -9.0, 0.0)
    assert many.is_counted
    assert many.point([0.0, 0.0, 0.0], 100.0).scaling == (0.0, 1.0)


def test_the_packets_that_complete_a_piece_are_counted() -> None:
    many = packets()
    counted = []
    for _ in range(9):
        packet = many.point([0.0, 0.0, 0.0], 100.0)
        counted.append(many.is_counted)
        assert packet.header.counter_step == many.is_counted
    assert counted == [False] * 6 + [True] * 3


@pytest.mark.parametrize(
    ("x", "is_float"),
    [(838.86065, True), (838.8608, False), (-900.00001, False)],
)
def test_far_away_a_float_is_no_nearer_than_the_pulses(x: float, is_float: bool) -> None:
    packet = packets().point([x, 0.0, 0.0], 100.0)
    assert isinstance(packet.targets[0][1], float) is is_float
    if not is_float:
        assert packet.targets[0][1] == round(x * 10_000)


def test_it_decodes_to_what_it_was() -> None:
    packet = packets().point([1.5, 2.25, -0.125], 100.0)
    assert Move.decode(packet.encode()) == packet


def test_the_set_up_of_a_machine_prepares_its_card_for_curves() -> None:
    shop = planned_shop()
    assert shop.controller.p[8224] == pytest.approx(0.004)
    assert shop.controller.p[8225] == 0.0
    assert shop.card.command("NURB RANK", program=0) == ["4"]
