"""A machine whose polls fail again and again does not go on without being watched."""

from collections.abc import Callable

import pytest
from tests.panel.bench import STEP_S, HandStation
from tests.panel.test_control_thread import Hand

from openacr.sysvar.tabs import SPINDLE

CAUSE = "ZeroDivisionError: nothing there"
ALARM = f"Control of the machine has failed: {CAUSE}"
PLACE_X = 12294  # the setpoint with all offsets


@pytest.fixture
def thread(hand: HandStation) -> Hand:
    """A machine with wired spindle and coolant."""
    store = hand.installation.store
    store.write(SPINDLE.cw_output, 40)
    store.write(SPINDLE.coolant_flood_output, 41)
    hand.station.renew(hand.now_s)
    hand.run(0.1)
    return Hand(hand)


class Broken:
    """A machine each of whose polls fails until it is mended; hold, outputs and power are noted."""

    def __init__(self, thread: Hand, monkeypatch: pytest.MonkeyPatch) -> None:
        self.count = 0
        self.calls: list[str] = []
        self._thread, self._patches = thread, monkeypatch
        runner = thread.hand.station.link.machine.runner
        monkeypatch.setattr(runner._supervision, "check", self._fail)
        for place, name in (
            (runner.machine, "hold"), (runner.entry_actions, "off"), (runner, "cut_power"),
        ):  # fmt: skip
            monkeypatch.setattr(place, name, self._noted(name, getattr(place, name)))

    def _fail(self, *_args: object) -> None:
        self.count += 1
        failing()

    def _noted(self, name: str, real: Callable[..., object]) -> Callable[..., object]:
        def noted(*args: object) -> object:
            self.calls.append(name)
            return real(*args)

        return noted

    def until(self, count: int) -> None:
        """Let time pass until this number of polls has failed."""
        while self.count < count:
            passing(self._thread, STEP_S)

    def mend(self) -> None:
        self._patches.undo()


def failing(*_args: object) -> None:
    raise ZeroDivisionError("nothing there")


def passing(thread: Hand, seconds: float) -> None:
    """Let time pass."""
    for _ in range(round(seconds / STEP_S)):
        thread.hand.now_s += STEP_S
        thread.turn(0.0)


def cut(thread: Hand) -> None:
    """Begin a cut of 50 s with turning spindle and coolant."""
    thread.hand.do("mdi.execute", lines=("M3 S500", "M8", "G91 G1 X50 F60"))
    thread.hand.until(lambda: outputs(thread.hand) == [True, True])
    while rests(thread):
        assert thread.hand.state in ("RUN", "WAIT", "IDLE")


def rests(thread: Hand) -> bool:
    """Whether the setpoint of X rests, as the card itself knows it."""
    controller = thread.hand.station.installation.controller
    assert controller is not None
    place = float(controller.p[PLACE_X])
    passing(thread, 0.1)
    return float(controller.p[PLACE_X]) == place


def alarms(hand: HandStation) -> list[str]:
    return [alarm.text for alarm in hand.station.link.machine.runner.alarms.active]


def outputs(hand: HandStation) -> list[bool]:
    """Spindle and coolant as the card switches them."""
    return [hand.station.link.machine.card.read_bit(output) for output in (40, 41)]


def test_the_fifth_failure_in_a_row_ends_the_run_hold_first_spindle_and_coolant_off(
    thread: Hand, monkeypatch: pytest.MonkeyPatch
) -> None:
    hand = thread.hand
    cut(thread)
    broken = Broken(thread, monkeypatch)
    broken.until(4)
    assert (hand.state, alarms(hand), broken.calls) == ("RUN", [], [])
    broken.until(5)
    assert (hand.state, alarms(hand)) == ("ALARM", [ALARM])
    assert broken.calls == ["hold", "off"]
    assert outputs(hand) == [False, False]
    event = hand.events("alarms")[-1]
    assert [(each["code"], each["text"]) for each in event["active"]] == [(19, ALARM)]
    passing(thread, 0.5)
    assert rests(thread)
    assert broken.calls == ["hold", "off"]


def test_a_run_that_has_ended_so_can_be_begun_again_once_polls_succeed(
    thread: Hand, monkeypatch: pytest.MonkeyPatch
) -> None:
    hand = thread.hand
    cut(thread)
    broken = Broken(thread, monkeypatch)
    broken.until(5)
    assert "not come to rest yet" in hand.refused("alarm.acknowledge")["text"]
    broken.mend()
    hand.until(lambda: not hand.is_busy)
    assert hand.state == "ALARM"
    assert hand.refused("mdi.execute", line="G1 X51 F600")["text"] == f"alarm 19: {ALARM}"
    hand.do("alarm.acknowledge")
    assert (hand.state, alarms(hand)) == ("IDLE", [])
    cut(thread)


def test_failures_with_a_poll_between_them_end_nothing(
    thread: Hand, monkeypatch: pytest.MonkeyPatch
) -> None:
    cut(thread)
    for _ in range(3):
        with monkeypatch.context() as patches:
            Broken(thread, patches).until(4)
        passing(thread, 0.02)
    assert (thread.hand.state, alarms(thread.hand)) == ("RUN", [])
    assert not rests(thread)


def test_an_axis_that_is_moved_by_an_increment_comes_to_rest(
    thread: Hand, monkeypatch: pytest.MonkeyPatch
) -> None:
    hand = thread.hand
    hand.do("jog.increment", axis="X", direction=1, distance=50.0, tick=hand.tick)
    passing(thread, 0.1)
    assert not rests(thread)
    Broken(thread, monkeypatch).until(5)
    assert alarms(hand) == [ALARM]
    passing(thread, 0.5)
    assert rests(thread)


@pytest.mark.parametrize("runs", [True, False])
def test_the_power_is_cut_when_the_time_to_come_to_rest_is_over(
    thread: Hand, monkeypatch: pytest.MonkeyPatch, runs: bool
) -> None:
    hand = thread.hand
    runner = hand.station.link.machine.runner
    if runs:
        cut(thread)
    broken = Broken(thread, monkeypatch)
    broken.until(5)
    ended_s, rest_s = hand.now_s, runner.settings.rest_s
    while hand.now_s < ended_s + rest_s - STEP_S / 2:
        assert "cut_power" not in broken.calls
        passing(thread, STEP_S)
    passing(thread, 0.5)
    assert broken.calls.count("cut_power") == int(runs)
    assert [alarm.kind.code for alarm in runner.alarms.active] == ([19, 15] if runs else [19])


def test_the_power_is_cut_at_once_where_the_run_cannot_be_ended(
    thread: Hand, monkeypatch: pytest.MonkeyPatch
) -> None:
    cut(thread)
    monkeypatch.setattr(thread.hand.station.link.machine.runner, "fail", failing)
    broken = Broken(thread, monkeypatch)
    broken.until(4)
    assert broken.calls == []
    broken.until(5)
    assert broken.calls[0] == "cut_power"
    passing(thread, 1.0)
    assert broken.calls.count("cut_power") == 1
    assert rests(thread)


def test_failures_without_a_machine_end_nothing(
    thread: Hand, monkeypatch: pytest.MonkeyPatch
) -> None:
    hand = thread.hand
    hand.station.close()
    monkeypatch.setattr(hand.station, "open", failing)
    hand.now_s += 10.0
    passing(thread, 0.02)
    assert hand.said[-1] == ALARM
