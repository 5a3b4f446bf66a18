"""STOP at the screens stops the card, also what another host has begun."""

from collections.abc import Callable, Iterator

import pytest
from tests.panel.bench import HandStation

from openacr.client import Card, Level
from openacr.map.rows import axes
from openacr.panel.control.operator.people import Person
from openacr.panel.roles import Role
from openacr.protocol.bits import SetBit

JOG_FORWARD = 796
LOOP = ("PROGRAM", "_again", "X1", "X0", "GOTO again", "ENDP")
STOPS = ("stop.hold", "stop.all", "stop.estop")


@pytest.fixture
def other(hand: HandStation) -> Iterator[Card]:
    """A second host of the same card."""
    controller = hand.installation.controller
    assert controller is not None
    card = Card.open(controller)
    for word in ("ACC 50 DEC 50 STP 50 VEL 1", "JOG ACC X50 Y50", "JOG DEC X50 Y50"):
        card.command(word, program=0)
    card.command("JOG VEL X1 Y1", program=0)
    yield card
    card.close()


def moves(hand: HandStation) -> bool:
    controller = hand.installation.controller
    assert controller is not None
    before = [controller.p[row] for row in axes.primary_setpoint]
    hand.run(0.2)
    return before != [controller.p[row] for row in axes.primary_setpoint]


def stopped(hand: HandStation) -> dict[str, object]:
    return hand.events("stopped")[-1]


def by_move(card: Card) -> None:
    card.command("X5", program=0)


def by_jog(card: Card) -> None:
    card.command("AXIS1 JOG REV", program=0)


def by_packet(card: Card) -> None:
    card.tell(SetBit(JOG_FORWARD))


def by_gear(card: Card) -> None:
    for line in ("AXIS2 GEAR SRC CLK", "AXIS2 GEAR PPU 1000", "AXIS2 GEAR ON"):
        card.command(line, program=0)


def by_program(card: Card) -> None:
    for line in LOOP:
        card.command(line, program=0)
    card.run(0)


@pytest.mark.parametrize("stop", STOPS)
@pytest.mark.parametrize("begin", [by_move, by_jog, by_packet, by_gear, by_program])
def test_every_stop_stops_what_another_host_has_begun(
    hand: HandStation, other: Card, begin: Callable[[Card], None], stop: str
) -> None:
    begin(other)
    hand.run(0.3)
    assert moves(hand)
    hand.do(stop)
    hand.run(1.3)
    assert not moves(hand)
    assert stopped(hand)["moving"] == []


@pytest.mark.parametrize("stop", STOPS)
def test_a_card_without_a_session_is_stopped_as_well(
    hand: HandStation, other: Card, stop: str
) -> None:
    by_jog(other)
    by_program(other)
    hand.run(0.3)
    hand.station.close()
    hand.station.link.retry_s = hand.now_s + 60.0  # its set-up is refused
    assert moves(hand)
    hand.do(stop)
    hand.run(1.3)
    assert not moves(hand)
    assert hand.station.link.session is None


def test_what_stop_has_held_without_a_session_is_resumed(hand: HandStation, other: Card) -> None:
    by_program(other)
    hand.run(0.3)
    hand.do("stop.hold")
    hand.run(2.0)
    assert stopped(hand) == {
        "event": "stopped", "found": ["PROG0 paused", "MASTER0 held"], "holds": True,
        "moving": [], "next": "stop.all",
    }  # fmt: skip
    hand.do("run.resume")
    hand.run(0.3)
    assert moves(hand)
    assert stopped(hand)["found"] == []


def test_what_moves_in_spite_of_a_stop_is_named_with_the_next_stronger_one(
    hand: HandStation, other: Card
) -> None:
    other.go(Level())
    other.command("DIM PLC0(2000)")
    other.go(Level.plc(0))
    for line in ("10 LDN 128", "20 OUT 796", "RUN"):
        other.command(line)
    hand.run(0.3)
    assert moves(hand)
    for stop, following in (("stop.hold", "stop.all"), ("stop.all", "stop.estop")):
        hand.do(stop)
        hand.run(1.3)
        assert (stopped(hand)["moving"], stopped(hand)["next"]) == (["X"], following)
    hand.do("stop.estop")
    hand.run(1.5)
    assert not moves(hand)
    assert stopped(hand)["moving"] == []


def test_motion_commanded_at_a_screen_after_a_stop_is_not_stopped_again(
    hand: HandStation, other: Card
) -> None:
    by_program(other)
    hand.run(0.3)
    hand.do("stop.all")
    hand.run(0.3)
    hand.do("card.flag", flag=JOG_FORWARD, on=True)
    hand.run(1.2)
    assert moves(hand)


def test_a_refused_command_does_not_end_the_watch(hand: HandStation, other: Card) -> None:
    hand.do("control.take", force=False)
    hand.do("stop.hold")
    viewer = Person(2, Role.SERVICE, "10.0.0.2")
    hand.station.join(viewer)
    answer = hand.send("card.flag", who=viewer, flag=JOG_FORWARD, on=True)
    assert not answer["ok"]
    by_jog(other)
    hand.run(1.2)
    assert not moves(hand)


def test_the_lamp_shows_what_another_host_moves_and_runs(hand: HandStation, other: Card) -> None:
    hand.run(0.6)
    assert hand.events("lamp")[-1]["moving"] == hand.events("lamp")[-1]["running"] == []
    by_program(other)
    other.command("DRIVE ON Y", program=0)
    hand.run(0.6)
    assert hand.events("lamp")[-1] == {
        "event": "lamp", "moving": ["X"], "running": ["PROG0"], "drives": ["Y"],
    }  # fmt: skip
    assert hand.state == "IDLE"
    hand.do("stop.all")
    hand.run(1.0)
    assert hand.events("lamp")[-1]["moving"] == hand.events("lamp")[-1]["running"] == []


def test_stop_stops_a_branch_that_goes_on_from_the_past(hand: HandStation, other: Card) -> None:
    beside = ("ATTACH MASTER1", 'ATTACH SLAVE0 AXIS5 "W"', "ACC 5000 DEC 5000 STP 5000 VEL 500")
    for line in (*beside, "PROGRAM", "_again", "W900", "W0", "GOTO again", "ENDP"):
        other.command(line, program=1)  # an axis that AcroMill does not have
    other.run(1)
    hand.run(1.0)
    hand.do("timeline.seek", tick=hand.station.times.history.lived_tk - 500)
    hand.do("timeline.operate")
    hand.run(0.5)
    assert moves(hand)
    hand.do("stop.hold")
    hand.run(1.3)
    assert not moves(hand)
    assert stopped(hand)["found"] == ["PROG1 paused", "MASTER1 held"]


@pytest.mark.parametrize("pause_s", [0.3, 2.0])
def test_a_second_stop_keeps_what_the_first_one_has_held(
    hand: HandStation, other: Card, pause_s: float
) -> None:
    by_program(other)
    hand.run(0.3)
    hand.do("stop.hold")
    hand.run(pause_s)
    by_jog(other)
    hand.run(0.1)
    hand.do("stop.hold")
    hand.run(2.0)
    assert stopped(hand)["found"] == ["PROG0 paused", "MASTER0 held", "AXIS1 stopped"]
    hand.do("run.resume")
    hand.run(0.3)
    assert moves(hand)
