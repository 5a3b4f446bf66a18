"""Before a machine moves: drives are enabled, inverted outputs are at rest."""

from collections.abc import Callable

import pytest
from tests.mill.shop import Shop, at, end, line

from openacr.client import ConnectionLostError
from openacr.client.drives import read_drives
from openacr.controller import Controller
from openacr.errors import UserError
from openacr.map.words import af4
from openacr.mill.card.driver import flag_of
from openacr.mill.run.lifecycle import State
from openacr.mill.session import MillSession
from openacr.sysvar import SettingError, Store

FLOOD, INVERTED = 800_010, 252_000


def test_the_drive_enable_output_is_on_from_the_first_motion_until_a_kill() -> None:
    shop = Shop(P400_013=45, P400_004=5)
    shop.pass_time(0.1)
    assert shop.outputs([45]) == [False]  # nothing is enabled unasked
    shop.finish(line(1, at(1)), end())
    assert shop.outputs([45]) == [True]  # and stays on after a program
    shop.controller.set_input(5, True)
    shop.pass_time(0.1)
    assert (shop.runner.state, shop.outputs([45])) == (State.ALARM, [False])
    shop.controller.set_input(5, False)
    shop.pass_time(0.1)
    shop.runner.acknowledge()
    shop.pass_time(0.1)
    assert shop.outputs([45]) == [False]  # not by an acknowledgement
    shop.card.command("DRIVE ON X Y Z", program=0)
    shop.finish(line(1, at(2)), end())
    assert shop.outputs([45]) == [True]


@pytest.mark.parametrize(
    "move",
    [
        lambda runner: runner.jog(lambda jog: jog.increment(0, 1, 2)),
        lambda runner: runner.home([0]),
        lambda runner: runner.run(lambda _host: iter([end()])),
    ],
)
@pytest.mark.parametrize("inverted", [0, 1])
def test_every_motion_enables_the_drives(move: Callable[..., object], inverted: int) -> None:
    shop = Shop(P400_013=45, P252_045=inverted)
    shop.controller.bit[45] = bool(inverted)
    move(shop.runner)
    assert shop.outputs([45]) == [not inverted]


def test_a_refused_motion_enables_nothing() -> None:
    shop = Shop(P400_013=45, P400_002=5)
    shop.controller.set_input(5, True)
    shop.pass_time(0.1)
    with pytest.raises(UserError, match="feed hold input is active"):
        shop.runner.jog(lambda jog: jog.increment(0, 1, 2))
    assert shop.outputs([45]) == [False]


DRIVE_IO = flag_of(af4.word[0], af4.DRIVE_I_O_ENABLE)  # of X; 32 more for each further axis
ESTOP_INPUT = 5


def with_drives() -> Shop:
    """Four drives with enable outputs; that of Y is off, axis 3 is not AcroMill's."""
    shop = Shop(P400_004=ESTOP_INPUT, P400_013=45, P800_010=41)
    for axis in range(4):
        shop.controller.bit[DRIVE_IO + 32 * axis] = True
        shop.card.command(f"AXIS{axis} DRIVE {'OFF' if axis == 1 else 'ON'}", program=0)
    shop.pass_time(0.1)
    assert drives(shop) == [True, False, True, True]
    return shop


def drives(shop: Shop) -> list[bool]:
    return [drive.is_enabled for drive in read_drives(shop.runner.machine.read_rows, range(4))]


def by_input(shop: Shop) -> None:
    shop.controller.set_input(ESTOP_INPUT, True)
    shop.pass_time(0.02)
    shop.controller.set_input(ESTOP_INPUT, False)


def by_screen(shop: Shop) -> None:
    shop.runner.kill("a test")


@pytest.mark.parametrize("stop", [by_input, by_screen])
def test_an_emergency_stop_switches_the_drives_of_all_axes_of_the_card_off(
    stop: Callable[[Shop], None],
) -> None:
    shop = with_drives()
    shop.start(line(1, at(50)), end())
    shop.runner.entry_actions.coolant.set(mist=False, flood=True)
    shop.pass_time(0.5)
    assert shop.outputs([41, 45]) == [True, True]
    stop(shop)
    shop.pass_time(0.1)
    assert drives(shop) == [False] * 4
    assert shop.outputs([41, 45]) == [False, False]
    shop.pass_time(1.5)
    at_rest = shop.pulses()
    shop.pass_time(0.5)
    assert shop.pulses() == at_rest


@pytest.mark.parametrize("stop", [by_input, by_screen])
def test_the_next_motion_switches_on_what_the_emergency_stop_has_switched_off(
    stop: Callable[[Shop], None],
) -> None:
    shop = with_drives()
    stop(shop)
    shop.pass_time(1.5)
    assert shop.runner.acknowledge() == []
    shop.pass_time(0.1)
    assert drives(shop) == [False] * 4  # not by an acknowledgement
    shop.finish(line(1, at(0, 0, 2)), end())
    assert drives(shop) == [True, False, True, False]  # Y was off before, A is not AcroMill's
    shop.card.command("DRIVE OFF Z", program=0)
    shop.finish(line(1, at(1)), end())
    assert drives(shop) == [True, False, False, False]  # once


def test_a_drive_that_stays_off_after_an_emergency_stop_bars_motion_and_says_why() -> None:
    shop = with_drives()
    shop.runner.kill("a test")
    shop.pass_time(1.5)
    shop.runner.acknowledge()
    fault = flag_of(af4.word[0], af4.DRIVE_FAULT_INPUT)
    shop.controller.bit[fault] = True
    with pytest.raises(UserError, match="drive of axis X stays off: the drive reports a fault"):
        shop.start(end())
    assert shop.runner.state is State.IDLE
    assert shop.outputs([45]) == [True]  # it may be ready only once it has its power
    shop.controller.bit[fault] = False
    shop.finish(line(1, at(1)), end())
    assert drives(shop) == [True, False, True, False]


def test_all_motion_is_killed_before_the_card_is_asked_anything(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """On a slow link the answer comes late, on one that breaks never."""
    shop = with_drives()
    killed = [flag_of(word, af4.KILL_ALL_MOTION_REQUEST) for word in af4.word[:4]]
    asked: list[list[bool]] = []

    def breaks(_whats: object) -> list[float]:
        asked.append([shop.controller.bit[flag] for flag in killed])
        raise ConnectionLostError("no answer")

    monkeypatch.setattr(shop.card, "read_many", breaks)
    with pytest.raises(ConnectionLostError):
        shop.runner.kill("a test")
    monkeypatch.undo()
    shop.controller.advance(seconds=0.1)
    assert asked == [[True] * 4]
    assert drives(shop) == [False] * 4


def test_an_emergency_stop_at_a_screen_acts_again_while_its_alarm_is_active() -> None:
    shop = with_drives()
    shop.runner.kill("a test")
    shop.pass_time(1.5)
    shop.card.command("AXIS3 DRIVE ON", program=0)
    shop.card.command("SET 41", program=0)
    shop.pass_time(0.1)
    assert (drives(shop)[3], shop.outputs([41])) == (True, [True])
    shop.runner.kill("a test")
    shop.pass_time(0.1)
    assert (drives(shop), shop.outputs([41])) == ([False] * 4, [False])


def test_an_axis_turned_by_hand_stays_where_it_is_when_its_drive_is_enabled() -> None:
    shop = Shop(P400_013=45)
    typed: list[str] = []
    real = shop.runner.machine.type

    def note(lines: object) -> None:
        typed.extend(listed := list(lines))  # type: ignore[call-overload]
        typed.append(f"output {shop.outputs([45])[0]}")
        real(listed)

    shop.runner.machine.type = note  # type: ignore[method-assign]
    shop.start(end())
    assert typed[:4] == ["REN X", "REN Y", "REN Z", "output False"]
    typed.clear()
    shop.until(State.IDLE)
    shop.start(end())
    assert "REN X" not in typed  # it is on


def real(controller: Controller, cells: dict[int, float]) -> MillSession:
    store = Store()
    for axis in range(3):
        store.write(200_007 + 1000 * axis, 0)
    for number, value in cells.items():
        store.write(number, value)
    return MillSession.real(controller, store, say=lambda _text: None)


def test_inverted_outputs_are_put_to_rest_once_after_the_card_came_on() -> None:
    controller, cells = Controller(), {FLOOD: 41, INVERTED + 41: 1.0}
    shop = real(controller, cells)
    assert [controller.bit[number] for number in (40, 41, 42)] == [False, True, False]
    shop.runner.entry_actions.coolant.set(mist=False, flood=True)
    assert not controller.bit[41]
    shop.close()
    again = real(controller, cells)
    assert not controller.bit[41]  # left on by the blocks typed before
    again.close()


def test_a_machine_with_two_purposes_of_one_output_is_not_run(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    read = Store.read
    monkeypatch.setattr(
        Store, "read", lambda store, n: 41.0 if n in (800_009, FLOOD) else read(store, n)
    )
    with pytest.raises(SettingError, match="output 41 is already used by"):
        MillSession.real(Controller(), Store(), say=print)
