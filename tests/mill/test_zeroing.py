"""SET ZERO, CLR ZERO and GOTO ZERO on a card."""

from collections.abc import Callable
from pathlib import Path

import pytest

from openacr.cnc.canonical import Point
from openacr.controller import Controller
from openacr.errors import UserError
from openacr.mill.card.alarms import AlarmError
from openacr.mill.session import MillSession
from openacr.mill.zeroing import clear_all, goto_zero, set_zero
from openacr.sysvar import Store

ACTIVE, SHIFT, ESTOP = 800, 801, 400_004
AXES = (0, 1, 2)


def shop_at(*blocks: str, store: Store | None = None) -> MillSession:
    """A machine that these blocks have brought somewhere."""
    store = store or Store()
    for axis in AXES:
        store.write(200_007 + 1000 * axis, 0)
    shop = MillSession.real(Controller(), store, lambda _text: None)
    shop.card.command("DRIVE ON X Y Z", program=0)
    mdi(shop, *blocks)
    return shop


def mdi(shop: MillSession, *blocks: str) -> None:
    list(shop.run_blocks(blocks, "acromill", lambda _shop: None))


def rounded(place: Point) -> tuple[float, ...]:
    return tuple(round(value, 4) + 0.0 for value in place[:3])


def machine_place(shop: MillSession) -> tuple[float, ...]:
    return rounded(shop.runner.stream.host.position())


def gone(shop: MillSession, *axes: int) -> list[tuple[float, ...]]:
    return [rounded(p) for p in goto_zero(shop, axes or AXES, lambda _shop: None)]


@pytest.mark.parametrize(
    ("z", "outcomes"),
    [
        (-1.0, [(1.0, 2.0, 0.0), (0.0, 0.0, 0.0)]),  # up first
        (1.0, [(0.0, 0.0, 1.0), (0.0, 0.0, 0.0)]),  # down last
        (0.0, [(0.0, 0.0, 0.0), (0.0, 0.0, 0.0)]),
    ],
)
def test_the_tool_axis_goes_up_first_and_down_last(
    z: float, outcomes: list[tuple[float, ...]]
) -> None:
    shop = shop_at(f"G0 X1 Y2 Z{z}")
    assert gone(shop) == outcomes
    assert machine_place(shop) == (0.0, 0.0, 0.0)


def test_only_the_axes_named_go_to_zero() -> None:
    shop = shop_at("G0 X1 Y2 Z3")
    assert gone(shop, 2) == [(1.0, 2.0, 0.0)]
    assert gone(shop, 1) == [(1.0, 0.0, 0.0)]


def test_the_zero_is_kept_by_the_store(tmp_path: Path) -> None:
    with Store(tmp_path / "sysvar.db") as store:
        shop = shop_at("G0 X1", store=store)
        set_zero(shop, AXES)
        shop.close()
    with Store(tmp_path / "sysvar.db") as store:
        assert (store.read(ACTIVE), store.read(SHIFT)) == (1.0, 1.0)


def test_a_machine_that_moves_or_has_an_alarm_gets_no_zero() -> None:
    store = Store()
    store.write(ESTOP, 4)
    shop = shop_at("G0 X1", store=store)
    shop.runner.jog(lambda jog: jog.move(0, 2.0))
    actions: list[Callable[[], object]] = [
        lambda: set_zero(shop, AXES), lambda: clear_all(shop), lambda: gone(shop),
    ]  # fmt: skip
    for act in actions[:2]:
        with pytest.raises(UserError, match="is moving: a zero can be set only at rest"):
            act()
    while shop.runner.is_busy:
        shop.step()
    shop.card._link._card.set_input(4, True)  # type: ignore[attr-defined]
    shop.step()
    for act in actions:
        with pytest.raises((UserError, AlarmError), match=r"E-STOP|EMERGENCY|mergency"):
            act()
    assert shop.cells.read(ACTIVE) == 0.0
    assert machine_place(shop) == (3.0, 0.0, 0.0)


def test_a_target_beyond_a_soft_limit_is_refused_by_goto_zero() -> None:
    store = Store()
    for cell, value in ((200_000, 2.0), (200_001, -2.0), (200_002, 0)):
        store.write(cell, value)
    shop = shop_at("G0 X1", store=store)
    store.write(271, 1)  # X is homed
    store.write(SHIFT, 5.0)
    gone(shop)
    assert [alarm.kind.code for alarm in shop.runner.alarms.active] == [21]
    assert machine_place(shop)[0] == 1.0
