"""Backlash of the OFFSETS tab: where the table is, on a machine whose screws have play."""

from contextlib import closing
from itertools import pairwise

import pytest
from tests.mill.shop import Shop

from openacr.mill.card.setup import prepare
from openacr.mill.config.settings import Settings
from openacr.mill.run.lifecycle import State
from openacr.mill.session import MillSession
from openacr.sysvar import Store
from openacr.sysvar.tabs import OFFSETS

SLACK_PULSES = (200.0, 0.0, 300.0)  # .02, 0 and .03 units
PRIMARY, SECONDARY, STRIDE = 12294, 12295, 256
SPREAD_TICKS = 20  # 10 ms at 0.5 ms


class Table:
    """The load of one axis: a nut that leaves its motor alone within the slack."""

    def __init__(self, slack: float, motor: float) -> None:
        self._slack = slack
        self.place = motor

    def follow(self, motor: float) -> float:
        self.place = min(max(self.place, motor - self._slack), motor)
        return self.place


def cut(text: str) -> tuple[list[list[float]], list[list[float]]]:
    """Commanded and real positions of the table for each axis, servo period by servo period."""
    shop = Shop(P950000=0.02, P950002=0.03)
    prepare(shop.card, Settings(shop.store), has_extensions=True)
    tables = [Table(slack, 0.0) for slack in SLACK_PULSES]
    wanted: list[list[float]] = [[], [], []]
    real: list[list[float]] = [[], [], []]
    shop.load(text)
    while shop.runner.state not in (State.IDLE, State.ALARM):
        for _ in range(10):
            shop.controller.advance(ticks=1)
            for axis, table in enumerate(tables):
                wanted[axis].append(float(shop.controller.p[PRIMARY + STRIDE * axis]))
                motor = float(shop.controller.p[SECONDARY + STRIDE * axis])
                real[axis].append(table.follow(motor))
        shop.runner.step()
    assert shop.runner.state is State.IDLE, [alarm.text for alarm in shop.runner.alarms.active]
    return wanted, real


def reversals(wanted: list[float]) -> set[int]:
    """The periods in which an axis is within 10 ms after it began to travel the other direction."""
    found: set[int] = set()
    direction = 0.0
    for tick, (before, after) in enumerate(pairwise(wanted), 1):
        step = after - before
        if step and step * direction <= 0.0:
            found |= set(range(tick, tick + SPREAD_TICKS + 2))
        direction = step or direction
    return found


@pytest.mark.req("MILL-OFS-BACKLASH")
@pytest.mark.parametrize(
    ("text", "turns"),
    [
        ("G1 F300 X1\nX0.5\nX0.7\nX-1\nX-0.5\nG4 F.1\nX-0.2\nX-0.3\nM2\n", (True, False, False)),
        (
            "G1 F300 X.5 Z-.5\nG2 X.5 Y0 I0 J0\nG3 X-.5 Y0 I0 J0\nG1 Z.5\nG0 X0 Z0\nM2\n",
            (True, True, True),
        ),
    ],
    ids=["lines", "circles"],
)
def test_the_table_is_where_it_was_commanded_after_every_reversal(
    text: str, turns: tuple[bool, bool, bool]
) -> None:
    wanted, real = cut(text)
    for axis in range(3):
        taken_up = reversals(wanted[axis])
        errors = [
            abs(a - b)
            for tick, (a, b) in enumerate(zip(wanted[axis], real[axis], strict=True))
            if tick not in taken_up
        ]
        assert max(errors) <= 1.0  # both are whole pulses
        assert bool(taken_up) is turns[axis]
    assert max(map(abs, wanted[0])) >= 5000


def test_by_the_sign_of_the_setpoint_the_table_is_off_by_the_slack() -> None:
    """As cards of the family do it: right on one side of a position only."""
    shop = Shop(P950000=0.02)
    table = Table(200.0, 0.0)
    for text in ("G1 F300 X1\nM2\n", "G1 F300 X0.5\nM2\n"):
        shop.run_text(text)
        shop.pass_time(0.02)
        table.follow(float(shop.controller.p[SECONDARY]))
    assert (shop.controller.p[PRIMARY], shop.controller.p[SECONDARY]) == (5000, 5200)
    assert table.place == 5200.0


def test_the_virtual_machine_takes_backlash_up_by_direction_and_other_cards_by_the_sign() -> None:
    store = Store()
    store.write(OFFSETS.backlash[0], 0.02)
    with closing(MillSession.virtual(store, lambda _text: None)) as session:
        assert session.card.command("AXIS0 BKL DIR", program=0) == ["1"]
        assert session.card.command("AXIS0 BKL", program=0) == ["0.02"]
    assert Shop(P950000=0.02).card.command("AXIS0 BKL DIR", program=0) == ["0"]
