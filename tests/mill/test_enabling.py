"""Before a machine moves: drives are enabled, inverted outputs are at rest."""

from collections.abc import Callable

import pytest
from tests.mill.shop import Shop, at, end, line

from openacr.controller import Controller
from openacr.errors import UserError
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
