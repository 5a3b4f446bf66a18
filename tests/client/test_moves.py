"""Streams of binary moves: full buffer rate, nothing lost, nothing held up."""

import asyncio

import pytest
from tests.client.cards import AXIS, WrappedLink

from openacr.client import AsyncCard, Card, ConnectionLostError, MoveStream
from openacr.controller import Controller
from openacr.errors import UserError
from openacr.protocol.move import Move
from openacr.protocol.move_codes import Code0

IN_MOTION = 516


def ready() -> tuple[Controller, Card]:
    """A card with axis X whose buffer holds ten moves."""
    host = Controller()
    card = Card.open(host)
    for line in (*AXIS, "MBUF ON", "ACC 0 DEC 0 STP 0"):
        card.command(line)
    return host, card


def steps(count: int) -> list[Move]:
    """A hundred moves per second of 0.1 unit each."""
    return [Move.of({0: 100 * n}, vel=10.0) for n in range(1, count + 1)]


def test_moves_run_into_each_other_at_full_rate() -> None:
    host, card = ready()
    before = host.tick
    assert card.send_moves(steps(300)) == 300
    assert host.until(IN_MOTION, False)
    assert host.p[12288] == 30000
    assert (host.tick - before) * host.period_s == pytest.approx(3.0, abs=0.02)


def test_a_stream_knows_what_has_started_and_never_overfills_the_buffer() -> None:
    host, card = ready()
    stream = MoveStream(depth=10)
    most = 0
    for move in steps(50):
        card.send_moves([move], stream)
        most = max(most, stream.waiting)
    assert most <= 10
    assert stream.sent == 50
    host.until(IN_MOTION, False)
    assert card.moves_started(stream) == 50
    assert stream.waiting == 0


def test_other_requests_pass_between_moves() -> None:
    host, card = ready()
    stream = MoveStream()
    card.send_moves(steps(30), stream)
    before = host.tick
    assert card.read_bit(IN_MOTION)
    assert (host.tick - before) * host.period_s < 0.005


def test_a_counter_that_has_counted_before_makes_no_difference() -> None:
    host, card = ready()
    card.write(8208, 12345)
    stream = MoveStream()
    card.send_moves(steps(20), stream)
    host.until(IN_MOTION, False)
    assert card.moves_started(stream) == 20


def test_moves_count_up_whatever_they_said() -> None:
    host, card = ready()
    down = [Move.of({0: 100}, code0=Code0.COUNTER | Code0.COUNT_DOWN), Move.of({0: 200})]
    card.send_moves(down)
    host.until(IN_MOTION, False)
    assert host.p[8208] == 2


def test_a_move_of_another_master_is_refused_before_anything_is_sent() -> None:
    host, card = ready()
    with pytest.raises(UserError, match="master 3"):
        card.send_moves([Move.of({0: 100}, master=3)])
    assert host.p[12288] == 0


class BreaksInMoves(WrappedLink):
    """A line that breaks after `left` more packets with moves."""

    left = 1000

    def write(self, data: bytes) -> None:
        if data.startswith(Move.HEADER):
            self.left -= 1
            if not self.left:
                self.close()
                raise ConnectionLostError("the line broke")
        super().write(data)


def test_after_a_broken_connection_a_host_knows_where_to_go_on() -> None:
    link = BreaksInMoves(Controller())
    card = Card(link)
    for line in (*AXIS, "MBUF ON", "ACC 0 DEC 0 STP 0"):
        card.command(line)
    moves, stream = steps(40), MoveStream()
    card.send_moves(moves[:12], stream)
    link.left = 4
    with pytest.raises(ConnectionLostError):
        card.send_moves(moves[12:], stream)
    card.wait(lambda: not card.master(0).is_in_motion)
    done = card.moves_started(stream)
    assert 12 <= done < 40
    assert card.axis(0).current_position == 100 * done
    card.send_moves(moves[done:])
    card.wait(lambda: not card.master(0).is_in_motion)
    assert card.axis(0).current_position == 4000


def test_the_asyncio_card_sends_moves_too() -> None:
    host, _ = ready()

    async def send() -> int:
        async with await AsyncCard.open(host) as card:
            return await card.send_moves(steps(40))

    assert asyncio.run(send()) == 40
    host.until(IN_MOTION, False)
    assert host.p[12288] == 4000
