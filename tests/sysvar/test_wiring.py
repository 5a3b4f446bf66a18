"""Wiring that cannot be: two purposes of one output, DAC or steering input."""

import pytest

from openacr.sysvar import SettingError, Store
from openacr.sysvar.rules import require_wiring

SPINDLE_CW, FLOOD, M12, M13 = 800_005, 800_010, 400_101, 400_102
G27_OUTPUT, G28_OUTPUT = 400_011, 400_019
FEED_HOLD, CYCLE_START, ESTOP, JOYSTICK, LUBRICATION = 400_002, 400_003, 400_004, 400_006, 400_012
SPINDLE_DAC, AXIS_DAC, CONFIGURED = 800_002, 200_014, 200_012
SPINDLE_FAULT, AT_ZERO, AT_SPEED = 800_008, 800_003, 800_004


@pytest.mark.parametrize(
    ("first", "second", "text"),
    [
        ((SPINDLE_CW, 40), (FLOOD, 40), "output 40 is already used by P800005 Spindle CW Output"),
        ((M12, 40), (M13, 40), "output 40 is already used by P400101 Discrete Output 1"),
        ((ESTOP, 5), (CYCLE_START, 5), "input 5 is already used by P400004 Emergency Stop"),
        ((CYCLE_START, 5), (ESTOP, 5), "input 5 is already used by P400003 Cycle Start Input"),
        ((FEED_HOLD, 5), (LUBRICATION, 5), "input 5 is already used by P400002 FeedHold Input"),
        ((JOYSTICK, 4), (CYCLE_START, 7), "input 7 is already used by P400006 Jog JoyStick Input"),
        ((AXIS_DAC, 0), (SPINDLE_DAC, 2), "DAC 2 is already used by P202014 DAC number"),
        ((SPINDLE_DAC, 3), (AXIS_DAC, 3), "DAC 3 is already used by P800002 Spindle DAC"),
        ((AXIS_DAC, 0), (AXIS_DAC, 1), "DAC 1 is already used by P201014 DAC number"),
    ],
)
def test_what_is_used_already_is_refused(
    first: tuple[int, int], second: tuple[int, int], text: str
) -> None:
    store = Store()
    store.write(*first)
    before = store.read(second[0])
    with pytest.raises(SettingError, match=text) as refused:
        store.write(*second)
    assert str(refused.value).startswith(f"P{second[0]} ")
    assert store.read(second[0]) == before


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ((G27_OUTPUT, 40), (G28_OUTPUT, 40)),
        ((AT_ZERO, 5), (AT_SPEED, 5)),  # one tachometer, distinguished by its level
        ((LUBRICATION, 5), (SPINDLE_FAULT, 5)),
        ((JOYSTICK, 4), (CYCLE_START, 8)),
        ((SPINDLE_CW, 40), (ESTOP, 8)),
        ((SPINDLE_DAC, 3), (AXIS_DAC + 3000, 4)),  # of an axis that is not there
        ((SPINDLE_DAC, 5), (SPINDLE_DAC, 3)),
    ],
)
def test_what_may_be_shared_is_not_refused(first: tuple[int, int], second: tuple[int, int]) -> None:
    store = Store()
    store.write(*first)
    store.write(*second)
    assert store.read(second[0]) == second[1]
    require_wiring(store)


def test_an_axis_that_is_added_needs_a_dac_of_its_own() -> None:
    store = Store()
    store.write(SPINDLE_DAC, 3)
    with pytest.raises(SettingError, match="DAC 3 is already used by P800002 Spindle DAC"):
        store.write(CONFIGURED + 3000, 1)


class Old(Store):
    """A store whose cells were written before they were compared."""

    def read(self, n: int) -> float:
        return {SPINDLE_CW: 40.0, FLOOD: 40.0}.get(n, super().read(n))


def test_a_store_from_before_is_refused_as_a_whole() -> None:
    with pytest.raises(SettingError, match="output 40 is already used by"):
        require_wiring(Old())


def test_the_dac_of_a_spindle_is_refused_as_a_whole() -> None:
    class Spindle(Store):
        def read(self, n: int) -> float:
            return 1.0 if n == SPINDLE_DAC else super().read(n)

    with pytest.raises(SettingError, match="DAC 1 is already used by"):
        require_wiring(Spindle())
