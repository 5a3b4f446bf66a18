"""Moves sent as packets, from the bytes to the encoder."""

import math
from collections.abc import Mapping
from itertools import pairwise
from typing import Any

import pytest
from tests.controller.hosts import Host

from openacr.channels import StreamKind
from openacr.controller import Controller
from openacr.map import numbers as at
from openacr.map.rows import axes
from openacr.protocol.bits import SetBit
from openacr.protocol.events import ControlKey
from openacr.protocol.move import Move
from openacr.protocol.move_codes import Code0, Code1, Code3

IN_MOTION, SPIRAL = 516, 2072
VELOCITY, COUNTER = 8193, 8208
SET_UP = (
    "PROG0",
    "ATTACH MASTER0",
    'ATTACH SLAVE0 AXIS0 "X"',
    'ATTACH SLAVE1 AXIS1 "Y"',
    'ATTACH SLAVE2 AXIS2 "Z"',
    "PPU X1000 Y1000 Z1000",
    "ACC 0 DEC 0 STP 0 VEL 100 MBUF ON",
)


class Sender:
    """A host that sends moves over the binary port."""

    def __init__(self, *lines: str) -> None:
        self.card = Controller()
        console = Host(self.card)
        console.type(*SET_UP, *lines)
        self.host = Host(self.card, StreamKind.PACKETS)

    def move(self, targets: Mapping[int, int | float], **fields: Any) -> "Sender":
        assert self.host.send(Move.of(targets, **fields).encode()) == ""
        return self

    def rest(self, limit_s: float = 20.0) -> "Sender":
        """Let all moves end."""
        assert self.card.until(IN_MOTION, False, timeout_s=limit_s)
        return self

    def ticks(self, count: int) -> "Sender":
        self.card.advance(count)
        return self

    @property
    def at(self) -> tuple[float, ...]:
        """Commanded positions of X, Y, Z in pulses, not rounded."""
        rows = (axes.position_cnt[axis] for axis in range(3))
        return tuple(self.card.memory.F[row] for row in rows)

    def peak(self, ticks: int) -> float:
        """The highest vector velocity of the next ticks."""
        found = 0.0
        for _ in range(ticks):
            self.card.advance(1)
            found = max(found, self.card.p[VELOCITY])
        return found


def test_velocity_and_ramps_of_a_packet_stay_for_later_moves() -> None:
    sender = Sender()
    sender.move({0: 1000}, vel=5.0, acc=200.0)
    assert sender.peak(300) == 5.0
    assert sender.card.p[8192 + at.MA_USER_VELOCITY] == 5.0
    sender.rest().move({0: 0})
    assert sender.peak(300) == 5.0


@pytest.mark.parametrize("by_hand", [False, True])
@pytest.mark.parametrize("ends", ["arrives", "is killed"])
def test_an_interrupt_of_one_packet_is_not_that_of_later_moves(by_hand: bool, ends: str) -> None:
    sender = Sender("SET 538" if by_hand else "CLR 538")
    sender.move({0: 1000}, vel=10.0, code1=Code1.INTERRUPT)
    sender.ticks(20)
    assert sender.card.bit[538]
    if ends == "is killed":
        sender.card.bit[522] = True
        sender.ticks(2)
        sender.card.bit[522] = False
    sender.rest().move({0: 3000})
    sender.ticks(20)
    assert sender.card.bit[IN_MOTION]
    assert sender.card.bit[538] == by_hand


def test_the_fvel_lockout_of_a_packet_shows_while_its_move_runs() -> None:
    sender = Sender("DEC 100", "FVEL 2")
    for move, locked in (({0: 1000}, False), ({0: 2000}, True), ({0: 3000}, False)):
        code0 = Code0.STP_RAMP | (Code0.FVEL_LOCKOUT if locked else 0)
        sender.move(move, vel=5.0, code0=code0)
    ends: list[float] = []
    while sender.card.bit[IN_MOTION]:
        place, last = sender.at[0], sender.card.p[VELOCITY]
        shown = sender.card.bit[525]
        sender.ticks(1)
        assert not 0.0 < place < 3000.0 or place % 1000 == 0 or shown == (1000.0 < place < 2000.0)
        if place // 1000 < sender.at[0] // 1000:
            ends.append(last)
    assert ends == [
        pytest.approx(2.0, abs=0.06),
        pytest.approx(0.0, abs=0.06),
        pytest.approx(2.0, abs=0.06),
    ]


def test_the_fvel_lockout_of_a_packet_can_be_lifted_by_hand() -> None:
    sender = Sender("DEC 100", "FVEL 2")
    sender.move({0: 1000}, vel=5.0, code0=Code0.STP_RAMP | Code0.FVEL_LOCKOUT)
    sender.ticks(100)
    assert sender.card.bit[525]
    sender.card.bit[525] = False
    while sender.card.bit[IN_MOTION]:
        last = sender.card.p[VELOCITY]
        sender.ticks(1)
    assert last == pytest.approx(2.0, abs=0.06)


def track(sender: Sender) -> list[tuple[float, ...]]:
    """Positions of every tick until the rest."""
    found = [sender.at]
    while sender.card.bit[IN_MOTION]:
        sender.ticks(1)
        found.append(sender.at)
    return found


@pytest.mark.req("BIN-152")
def test_a_start_beside_the_arc_jumps_onto_it_or_spirals_in_spiral_mode() -> None:
    arc = {"vel": 5.0, "centers": (0, 0), "code1": Code1.COUNTERCLOCKWISE}
    sender = Sender()
    sender.move({0: 1200}).rest().move({0: 0, 1: 1000}, **arc)
    assert {round(math.hypot(x, y)) for x, y, _ in track(sender)[1:]} == {1000}
    sender = Sender()
    sender.host.send(SetBit(SPIRAL).encode())
    sender.move({0: 1200}).rest().move({0: 0, 1: 1000}, **arc)
    radii = [math.hypot(x, y) for x, y, _ in track(sender)]
    assert radii == sorted(radii, reverse=True)
    assert max(a - b for a, b in pairwise(radii)) < 1


def test_nothing_is_lost_and_nothing_waits_when_a_host_sends_as_fast_as_it_can() -> None:
    sender = Sender("P8208=0")
    for step in range(1, 501):
        while not sender.card.accepts_input(sender.host.stream):
            sender.ticks(1)
        sender.move({0: 10 * step}, vel=10.0, code0=Code0.COUNTER)
    assert sender.rest().at == (5000, 0, 0)
    assert sender.card.p[COUNTER] == 500


def test_only_the_sender_of_too_many_moves_is_held_back() -> None:
    sender = Sender()
    other = Host(sender.card, StreamKind.PACKETS)
    step = 0
    while sender.card.accepts_input(sender.host.stream):
        step += 1
        sender.move({0: 10 * step}, vel=10.0)
    assert step > 1000
    assert sender.card.accepts_input(other.stream)
    assert other.raw(bytes.fromhex("00 88 01 10")) == bytes.fromhex("00 88 01 10 00 00 00 00")
    sender.ticks(10)
    assert sender.card.accepts_input(sender.host.stream)


def test_keys_and_packets_pass_moves_that_wait() -> None:
    sender = Sender()
    text = Host(sender.card)
    packets = b"".join(Move.of({0: 1000 * n}, vel=10.0).encode() for n in range(1, 201))
    get = bytes.fromhex("00 88 00 20")
    sender.card.receive(text.stream, packets + get)
    assert sender.card.take_output(text.stream)[:4] == get
    sender.ticks(100)
    assert sender.card.bit[IN_MOTION]
    text.send("\x18")
    sender.ticks(400)
    assert not sender.card.bit[IN_MOTION]
    assert sender.at[0] < 5000


def test_a_chain_of_waiting_moves_runs_without_a_gap() -> None:
    sender = Sender()
    for step in range(1, 61):
        sender.move({0: 10 * step}, vel=10.0)
    start = sender.card.tick
    sender.rest()
    assert sender.card.tick - start == pytest.approx(600 / 10 / 1000 / 0.0005, abs=2)


@pytest.mark.parametrize("flag", [522, 8467])
def test_a_kill_drops_the_moves_that_wait(flag: int) -> None:
    sender = Sender()
    for step in range(1, 61):
        sender.move({0: 1000 * step}, vel=10.0)
    sender.ticks(100)
    sender.host.send(SetBit(flag).encode())
    sender.ticks(200)
    assert not sender.card.bit[IN_MOTION]
    stopped = sender.at
    sender.card.press(ControlKey.CTRL_Y)
    sender.ticks(500)
    assert sender.at == stopped
    assert sender.move({0: 0}).rest().at == (0, 0, 0)


def test_waiting_moves_are_part_of_a_snapshot() -> None:
    sender = Sender()
    for step in range(1, 41):
        sender.move({0: 100 * step}, vel=10.0)
    sender.ticks(20)
    kept = sender.card.snapshot()
    first = sender.rest().card.digest()
    sender.card.restore(kept)
    assert sender.rest().card.digest() == first
    assert sender.at == (4000, 0, 0)


@pytest.mark.parametrize(
    "refused",
    [
        Move.of({0: 1}, master=5),
        Move.of({7: 1}),
        Move.of({0: 1, 1: 1}, centers=(5, 5), code1=3 << 6),
        Move.of({0: 1000}, vel=-1.0),
        Move.of({}, code1=Code1.SPLINE, code3=Code3.CURVE),
    ],
    ids=str,
)
def test_an_impossible_move_changes_nothing(refused: Move) -> None:
    sender = Sender()
    before = sender.card.digest()
    assert sender.host.send(refused.encode()) == ""
    assert sender.card.digest() == before


SPLINE = {"code1": Code1.SPLINE, "code3": Code3.CURVE}
TIMED_SPLINE = {"code1": Code1.SPLINE | Code1.SPLINE_KNOTS, "code3": Code3.CURVE}


@pytest.mark.parametrize(("curve", "ticks"), [(SPLINE, 5000), (TIMED_SPLINE, 3500)])
def test_the_scaling_of_a_spline_packet_is_no_knot_without_its_bit(
    curve: dict[str, int], ticks: int
) -> None:
    sender = Sender()
    relative = {"code3": Code3.CURVE | Code3.INCREMENTAL_TARGET}
    for scaling in ((0.5, 0.0), (0.75, 0.0)):
        sender.move({0: 500}, **curve | relative, scaling=scaling)
    sender.move({0: 500}, **TIMED_SPLINE | relative, scaling=(-0.5, 0.0))
    start = sender.card.tick
    sender.rest()
    assert sender.card.tick - start == ticks
    assert sender.at == (1500, 0, 0)


def test_curves_of_many_packets_wait_for_room() -> None:
    sender = Sender("SPLINE MODE 1")
    for step in range(1, 41):
        sender.move({0: 100 * step}, **SPLINE)
    sender.move({0: 4000}, **TIMED_SPLINE, scaling=(-1.0, 0.0)).rest()
    assert sender.at == (4000, 0, 0)


def rounded(*, is_restored: bool = False) -> list[tuple[float, ...]]:
    """Places on the way round a corner of which only the packet knows a tolerance."""
    sender = Sender("ACC 1000 DEC 1000 STP 1000")
    stopping = {"code0": Code0.STP_RAMP | Code0.FVEL_LOCKOUT}
    for n in range(1, 16):  # more than the buffer holds
        side = {0: 1000 * n, 1: 1000 * n} if n % 2 else {0: 1000 * (n + 1), 1: 1000 * n}
        sender.move(side, tolerance=0.2, **stopping)
    if is_restored:
        snapshot = sender.card.snapshot()
        sender.card = Controller()
        sender.card.restore(snapshot)
    places = []
    while sender.card.bit[IN_MOTION]:
        places.append(sender.ticks(1).at)
    return places


def test_a_packet_brings_a_path_tolerance_along_without_look() -> None:
    places = rounded()
    assert places[-1][:2] == (15000, 15000)
    nearest = min(math.dist(place[:2], (3000, 2000)) for place in places)
    turn, reach = math.dist((0.0, 1.0), (2 / 5**0.5, 1 / 5**0.5)), 500  # half a move
    assert nearest == pytest.approx(reach * turn / 4, rel=0.02)
    assert nearest < 200


def test_tolerances_of_waiting_packets_survive_a_snapshot() -> None:
    assert rounded(is_restored=True) == rounded()
