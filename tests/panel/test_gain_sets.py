"""Every set of gains that an axis has had can be set again, on a station driven by hand."""

from typing import Any

import pytest
from tests.panel.bench import HandStation

from openacr.map.rows import axes
from openacr.panel.control.engineer import gain_sets
from openacr.panel.control.engineer.gain_sets import SAME_S
from openacr.panel.control.operator.orders import Order
from openacr.sysvar.tabs import SERVO

P, D = "axis0.proportional gain", "axis0.derivative gain"


def read(hand: HandStation, what: str) -> float:
    return float(hand.station.link.machine.card.read(what))


def put(hand: HandStation, gain: str, value: float, *, wait_s: float = SAME_S + 0.1) -> None:
    hand.run(wait_s)
    hand.do("gain.set", axis="X", gain=gain, value=value, store=False)


def sets(hand: HandStation) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = hand.do("tune.sets", axis="X")["sets"]
    return found


def shown(hand: HandStation) -> list[tuple[str, list[list[Any]]]]:
    return [(each["by"], each["changed"]) for each in sets(hand)]


def test_each_set_is_listed_with_what_it_changes_and_any_of_them_comes_back(
    hand: HandStation,
) -> None:
    first, second = read(hand, P), read(hand, D)
    assert shown(hand) == [("start", [])]
    put(hand, "P Gain", 0.004)
    put(hand, "D Gain", 2e-5)
    put(hand, "P Gain", 0.006)
    found = sets(hand)
    values = [read(hand, P), read(hand, D)]
    assert values == [pytest.approx(0.006), pytest.approx(2e-5)]
    assert [each["by"] for each in found] == ["start", "here", "here", "here"]
    assert [[word for word, *_ in each["changed"]] for each in found] == [
        [], ["P Gain"], ["D Gain"], ["P Gain"],
    ]  # fmt: skip
    assert found[3]["changed"][0][1:] == [pytest.approx(0.004), pytest.approx(0.006)]
    ages = [each["age_s"] for each in found]
    assert ages == sorted(ages, reverse=True)
    assert ages[2] - ages[3] == pytest.approx(SAME_S + 0.1, abs=0.01)
    back = hand.do("tune.back", axis="X", number=found[1]["number"])
    assert back["current"] == found[1]["number"]
    assert [read(hand, P), read(hand, D)] == [pytest.approx(0.004), second]
    hand.do("tune.back", axis="X", number=found[0]["number"])
    assert [read(hand, P), read(hand, D)] == [first, second]
    hand.do("tune.back", axis="X", number=found[3]["number"])  # none is lost by going back
    assert [read(hand, P), read(hand, D)] == values
    assert shown(hand) == [(each["by"], each["changed"]) for each in found]


def test_after_going_back_another_set_follows_those_that_are_there(hand: HandStation) -> None:
    first = read(hand, P)
    put(hand, "P Gain", 0.004)
    put(hand, "P Gain", 0.006)
    hand.do("tune.back", axis="X", number=1)
    put(hand, "P Gain", 0.007, wait_s=0.1)  # soon after the last one, which is not in force
    assert [(each["number"], each["before"]) for each in sets(hand)] == [
        (1, 0), (2, 1), (3, 2), (4, 1),
    ]  # fmt: skip
    assert sets(hand)[3]["changed"][0][1:] == [pytest.approx(first), pytest.approx(0.007)]
    assert hand.do("tune.sets", axis="X")["current"] == 4
    hand.do("tune.back", axis="X", number=3)
    assert read(hand, P) == pytest.approx(0.006)


def test_what_another_host_changes_is_a_set_of_its_own(hand: HandStation) -> None:
    put(hand, "P Gain", 0.004)
    hand.run(0.5)
    hand.station.link.machine.card.command("AXIS0 PGAIN 0.005")
    hand.do("gain.set", axis="X", gain="D Gain", value=2e-5, store=False)
    hand.station.link.machine.card.command("AXIS0 IGAIN 0.5")
    assert [(by, [word for word, *_ in changed]) for by, changed in shown(hand)] == [
        ("start", []),
        ("here", ["P Gain"]),
        ("elsewhere", ["P Gain"]),
        ("here", ["D Gain"]),
        ("elsewhere", ["I Gain"]),
    ]
    hand.do("tune.back", axis="X", number=3)
    assert [read(hand, P), read(hand, "axis0.integral gain")] == [pytest.approx(0.005), 0.0]


def test_a_slider_that_moves_makes_one_set_and_a_pause_or_another_gain_the_next(
    hand: HandStation,
) -> None:
    for value in (0.003, 0.004, 0.005):
        put(hand, "P Gain", value, wait_s=SAME_S)
    assert [len(changed) for _by, changed in shown(hand)] == [0, 1]
    assert sets(hand)[1]["changed"][0][2] == pytest.approx(0.005)
    put(hand, "D Gain", 2e-5, wait_s=0.1)
    put(hand, "P Gain", 0.006, wait_s=0.1)
    put(hand, "P Gain", 0.007)
    names = [[word for word, *_ in changed] for _by, changed in shown(hand)]
    assert names == [[], ["P Gain"], ["D Gain"], ["P Gain"], ["P Gain"]]


def test_filters_come_back_with_the_gains(hand: HandStation) -> None:
    command = hand.station.link.machine.card.command
    assert len(sets(hand)) == 1
    command("AXIS0 NOTCH (330,40)")
    command("AXIS0 LOPASS 200")
    assert sets(hand)[1]["changed"] == [["LOPASS", "0", "200"], ["NOTCH", "0,0", "330,40"]]
    hand.do("tune.back", axis="X", number=1)
    asked = [command(f"AXIS0 {word}") for word in ("LOPASS", "NOTCH")]
    assert asked == [["0"], ["0,0"]]
    text = hand.refused("tune.back", axis="X", number=2, store=True)["text"]
    assert "have no NOTCH and LOPASS" in text
    hand.do("tune.back", axis="X", number=2)
    assert command("AXIS0 NOTCH") == ["330,40"]


def test_filters_that_were_written_by_hand_are_not_set_again(hand: HandStation) -> None:
    session = hand.station.link.machine
    session.card.command("SET BIT786")
    session.card.command(f"P{axes.filter0_a0[0]}=0.5")
    number = hand.do("tune.sets", axis="X")["current"]
    before = read(hand, P)
    session.card.command("AXIS0 LOPASS 100")
    put(hand, "P Gain", 0.009)
    text = hand.refused("tune.back", axis="X", number=number)["text"]
    assert text == f"set {number}: its filters were written by hand, no command sets them again"
    assert read(hand, P) == pytest.approx(0.009) != before


def test_a_change_elsewhere_is_never_that_of_a_slider_which_moves(hand: HandStation) -> None:
    put(hand, "P Gain", 0.004)
    hand.station.link.machine.card.command("AXIS0 PGAIN 0.005")
    assert [by for by, _changed in shown(hand)] == ["start", "here", "elsewhere"]


def test_a_set_that_is_kept_is_stored_in_the_parameters(hand: HandStation) -> None:
    first = read(hand, P)
    put(hand, "P Gain", 0.004)
    hand.do("tune.back", axis="X", number=1, store=True)
    stored = hand.station.installation.store.read(SERVO.p_gain[0])
    assert stored == pytest.approx(first)
    assert read(hand, P) == first


def test_a_set_that_is_not_there_is_named_with_those_that_are(hand: HandStation) -> None:
    put(hand, "P Gain", 0.004)
    text = hand.refused("tune.back", axis="X", number=3)["text"]
    assert text == "set 3 of gains is not there (kept: 1 to 2)"
    assert "no axis Q" in hand.refused("tune.sets", axis="Q")["text"]


def test_the_first_set_is_kept_when_the_oldest_are_dropped(
    hand: HandStation, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(gain_sets, "MOST", 3)
    for value in (0.003, 0.004, 0.005, 0.006):
        put(hand, "P Gain", value)
    assert [each["number"] for each in sets(hand)] == [1, 4, 5]


def test_gains_that_the_card_tries_are_one_set_and_no_change_elsewhere(hand: HandStation) -> None:
    hand.do("tune.measure", axis="X", time_s=0.5, bandwidth_hz=30.0)
    answers: list[dict[str, Any]] = []
    order = Order(hand.me, "tune.apply", {"axis": "X"}, hand.now_s, answers.append)
    hand.station.order(order, hand.now_s)
    first = read(hand, P)
    hand.until(lambda: read(hand, P) != first)
    assert answers == []
    assert shown(hand) == [("start", [])]  # they may be taken back
    assert "axis X is measured" in hand.refused("tune.back", axis="X", number=1)["text"]
    hand.until(lambda: not hand.station.tuning.is_moving)
    assert [by for by, _changed in shown(hand)] == ["start", "here"]
    hand.until(lambda: bool(answers))
    found = sets(hand)
    assert [each["by"] for each in found] == ["start", "here"]
    assert "P Gain" in [word for word, *_ in found[1]["changed"]]
    hand.do("tune.back", axis="X", number=1)
    assert hand.do("tune.sets", axis="X")["current"] == 1
