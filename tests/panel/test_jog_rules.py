"""The rules of motion by held keys, on a station whose time passes by hand."""

import pytest
from tests.panel.bench import HandStation

from openacr.map.rows import encoders
from openacr.panel.control.operator.people import Person
from openacr.panel.roles import Role


def ended(hand: HandStation) -> list[tuple[int, str]]:
    return [(event["press"], event["ended"]) for event in hand.events("jog")]


def test_an_axis_moves_while_its_key_is_held_and_stops_at_its_release(hand: HandStation) -> None:
    assert hand.press(1)["ok"]
    hand.keep(1, 1.0)
    assert hand.speeds(0.04)[0] == pytest.approx(10.0, abs=0.3)  # 600 mm/min
    hand.do("jog.release", press=1)
    hand.run(0.3)
    assert hand.speeds() == (0.0, 0.0, 0.0)
    assert ended(hand) == [(1, "released")]


def test_a_key_that_is_not_kept_alive_stops_after_200_ms(hand: HandStation) -> None:
    hand.press(1)
    hand.run(0.198)
    assert ended(hand) == []
    hand.run(0.006)
    assert ended(hand) == [(1, "silence")]
    hand.run(0.3)
    assert hand.speeds() == (0.0, 0.0, 0.0)


def test_a_press_that_has_ended_never_comes_back(hand: HandStation) -> None:
    hand.press(1)
    hand.run(0.3)
    hand.run(0.5)
    at = hand.places()
    hand.keep(1, 0.5)
    assert hand.press(1)["error"]["code"] == "refused"
    hand.run(0.5)
    assert hand.places() == at
    assert ended(hand) == [(1, "silence")]


def test_a_keep_alive_never_begins_motion(hand: HandStation) -> None:
    hand.keep(7, 0.5)
    assert hand.places() == (0.0, 0.0, 0.0)
    assert ended(hand) == []


def test_a_press_without_first_is_refused(hand: HandStation) -> None:
    error = hand.refused("jog.press", press=1, axis="X", direction=1, tick=hand.tick)
    assert error["code"] == "bad"
    assert "first" in error["text"]


@pytest.mark.parametrize(("age_s", "is_taken"), [(0.19, True), (0.25, False)])
def test_a_press_by_a_screen_with_old_positions_is_refused(
    hand: HandStation, age_s: float, is_taken: bool
) -> None:
    tick = hand.tick
    read_s = hand.station.snapshot.read_s
    while hand.now_s - read_s < age_s - 0.001:
        hand.run(0.002)
    assert hand.press(1, tick=tick)["ok"] is is_taken
    hand.run(0.1)
    assert (hand.places()[0] > 0.0) is is_taken


def test_a_screen_with_an_unknown_tick_moves_nothing(hand: HandStation) -> None:
    for number, tick in enumerate((hand.tick + 1000.0, -1.0, 12.34)):
        assert hand.press(number, tick=tick)["error"]["code"] == "stale"
    hand.run(0.2)
    assert hand.places() == (0.0, 0.0, 0.0)


def test_keeps_of_a_blind_screen_do_not_count(hand: HandStation) -> None:
    tick = hand.tick
    hand.press(1)
    for _ in range(20):
        hand.run(0.05)
        hand.send("jog.keep", press=1, tick=tick)
    assert ended(hand) == [(1, "silence")]
    travel = hand.places()[0]
    assert 2.0 < travel < 4.5  # about 350 ms at 10 mm/s, and a ramp


def test_a_press_that_waited_in_the_queue_is_refused(hand: HandStation) -> None:
    tick, old_s = hand.tick, 0.21
    hand.run(0.21)
    answer = hand.press(1, tick=tick, old_s=old_s)
    assert answer["error"]["code"] == "stale"
    hand.run(0.2)
    assert hand.places() == (0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("command", "args", "why"),
    [
        ("stop.hold", {}, "stop"),
        ("stop.all", {}, "stop"),
        ("stop.estop", {}, "stop"),
        ("jog.stop", {}, "stop"),
        ("mode", {"mode": "mdi"}, "mode"),
        ("control.release", {}, "control"),
    ],
)
def test_everything_that_stops_ends_the_press(
    hand: HandStation, command: str, args: dict[str, str], why: str
) -> None:
    hand.press(1)
    hand.press(2, "Y", -1)
    hand.keep(1, 0.0)
    for _ in range(4):
        hand.run(0.05)
        hand.send("jog.keep", press=1, tick=hand.tick)
        hand.send("jog.keep", press=2, tick=hand.tick)
    hand.do(command, **args)
    assert ended(hand) == [(1, why), (2, why)]
    hand.run(0.5)
    assert hand.speeds() == (0.0, 0.0, 0.0)
    hand.keep(1, 0.3)
    assert hand.speeds() == (0.0, 0.0, 0.0)


def test_a_viewer_may_stop_what_another_operator_moves(hand: HandStation) -> None:
    viewer = Person(9, Role.VIEW, "10.0.0.9")
    hand.station.join(viewer)
    hand.press(1)
    hand.run(0.1)
    assert hand.send("stop.hold", who=viewer)["ok"]
    hand.run(0.5)
    assert hand.speeds() == (0.0, 0.0, 0.0)


def test_only_the_operator_in_control_moves_axes(hand: HandStation) -> None:
    other = Person(2, Role.OPERATE, "10.0.0.2")
    hand.station.join(other)
    hand.press(1)
    hand.do("jog.release", press=1)
    hand.run(0.5)
    answer = hand.press(1, who=other)
    assert answer["error"]["code"] == "control"
    assert answer["error"]["holder"]["client"] == 1
    assert hand.send("control.take", who=other)["error"]["code"] == "control"
    assert hand.station.people.data()["asking"][0]["client"] == 2
    hand.do("control.give", client=2)
    assert hand.press(2, who=other)["ok"]
    hand.run(0.1)
    assert hand.places()[0] > 0.0


def test_the_control_of_a_browser_that_has_gone_is_free_and_its_axis_stops(
    hand: HandStation,
) -> None:
    hand.press(1)
    hand.run(0.1)
    hand.station.leave(1)
    assert ended(hand) == [(1, "link")]
    hand.run(0.5)
    assert hand.speeds() == (0.0, 0.0, 0.0)
    other = Person(2, Role.OPERATE, "10.0.0.2")
    hand.station.join(other)
    assert hand.press(1, who=other)["ok"]


def test_taking_control_by_force_stops_the_axes_of_the_other(hand: HandStation) -> None:
    other = Person(2, Role.OPERATE, "10.0.0.2")
    hand.station.join(other)
    hand.press(1)
    hand.run(0.1)
    assert hand.send("control.take", who=other, force=True)["ok"]
    assert ended(hand) == [(1, "control")]
    hand.run(0.5)
    assert hand.speeds() == (0.0, 0.0, 0.0)


def test_a_second_key_of_one_axis_stops_both(hand: HandStation) -> None:
    hand.press(1)
    hand.run(0.1)
    assert "both stop" in hand.press(2, "X", -1)["error"]["text"]
    hand.run(0.5)
    assert hand.speeds() == (0.0, 0.0, 0.0)
    assert ended(hand) == [(1, "stop")]


def test_an_increment_while_a_key_is_held_stops_and_moves_nothing(hand: HandStation) -> None:
    hand.press(1)
    hand.run(0.1)
    error = hand.refused("jog.increment", axis="Y", direction=1, preset=3, tick=hand.tick)
    assert error["code"] == "refused"
    hand.run(0.5)
    assert hand.speeds() == (0.0, 0.0, 0.0)
    assert hand.places()[1] == 0.0
    assert ended(hand) == [(1, "stop")]


def test_an_increment_moves_by_the_preset_of_the_store(hand: HandStation) -> None:
    hand.do("jog.increment", axis="Y", direction=-1, preset=4, tick=hand.tick)
    hand.until(lambda: not hand.is_busy)
    hand.run(0.1)
    assert hand.places() == (0.0, -5.0, 0.0)
    hand.do("jog.increment", axis="X", direction=1, distance=0.25, tick=hand.tick)
    hand.until(lambda: not hand.is_busy)
    hand.run(0.1)
    assert hand.places() == (0.25, -5.0, 0.0)


def test_an_alarm_ends_the_press(hand: HandStation) -> None:
    hand.press(1)
    hand.keep(1, 0.2)
    hand.station.link.machine.runner.kill("test")
    hand.run(0.03)
    assert ended(hand) == [(1, "alarm")]
    hand.run(1.0)
    hand.keep(1, 0.3)
    assert hand.speeds() == (0.0, 0.0, 0.0)


def with_wheel(hand: HandStation) -> None:
    """A wheel on encoder 10 for X and Y; the session is opened again with it."""
    rows = ((200_009, 10.0), (200_010, 0.005), (201_009, 10.0), (201_010, 0.02))
    for number, value in rows:
        hand.installation.store.write(number, value)
    hand.station.renew(hand.now_s)
    hand.run(0.1)


def turned(hand: HandStation, clicks: int) -> tuple[float, ...]:
    """Where the axes are after clicks of the wheel, of 4 counts each, 10 ms apart."""
    assert hand.installation.controller is not None
    for _ in range(clicks):
        hand.installation.controller.p[encoders.parameters[10]] += 4
        hand.run(0.01)
    hand.run(0.5)
    return hand.places()


def test_the_hand_wheel_moves_the_axes_of_the_command_until_it_is_disconnected(
    hand: HandStation,
) -> None:
    with_wheel(hand)
    assert turned(hand, 5) == (0.0, 0.0, 0.0)
    assert hand.do("handwheel", axes="xy") == {"axes": "XY"}
    assert turned(hand, 5) == pytest.approx((5 * 0.005, 5 * 0.02, 0.0))
    assert hand.do("handwheel", axes="Y") == {"axes": "Y"}
    assert turned(hand, 5) == pytest.approx((5 * 0.005, 10 * 0.02, 0.0))
    assert hand.do("handwheel") == {"axes": ""}
    assert turned(hand, 5) == pytest.approx((5 * 0.005, 10 * 0.02, 0.0))


def test_the_hand_wheel_is_refused_for_an_axis_without_one_and_ends_held_keys(
    hand: HandStation,
) -> None:
    with_wheel(hand)
    hand.press(1)
    text = "cannot use the hand wheel: an axis is being jogged"
    assert hand.refused("handwheel", axes="X")["text"] == text
    assert ended(hand) == [(1, "mode")]
    hand.run(0.5)
    text = "no hand wheel is installed for axis Z"
    assert hand.refused("handwheel", axes="XZ") == {"code": "refused", "text": text}
    at = hand.places()
    assert turned(hand, 5) == at
