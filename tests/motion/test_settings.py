"""Settings: where values lie, what is refused, and what hangs on them."""

import pytest

from openacr.errors import CardError
from openacr.map import numbers as at
from openacr.motion.axis import attach, settings
from openacr.motion.axis.settings import (
    not_negative,
    not_zero,
    of_axis,
    of_axis_int,
    of_axis_long,
    of_axis_real,
    of_master,
    of_master_real,
)
from openacr.motion.card import Card

AXIS, MASTER, DZU = 3, 2, 12288 + 3 * 256 + 115
SLAVE_MAX_VEL = 2076


def test_a_setting_with_a_parameter_is_the_parameter() -> None:
    card = Card()
    of_axis(at.AX_PPU).write(card, AXIS, 2.5)
    of_axis_long(at.AX_DZU).write(card, AXIS, -7.9)
    of_master(at.MA_MANUAL_VECTOR).write(card, MASTER, 4.0)
    assert [card.memory.read(number) for number in (13143, DZU, 8714)] == [2.5, -7, 4.0]


@pytest.mark.parametrize(
    "setting",
    [
        of_axis(at.AX_PPU),
        of_axis_long(at.AX_DZU),
        of_axis_real(at.AXF_HLDEC_UPS2),
        of_axis_int(at.AXI_HLBIT),
        of_master(at.MA_MANUAL_VECTOR),
        of_master_real(at.MSF_JRK_UPS3),
    ],
)
def test_every_object_has_a_value_of_its_own(setting: settings.Setting) -> None:
    card = Card()
    for number in range(16):
        setting.write(card, number, number + 5)
    assert [setting.read(card, number) for number in range(16)] == [n + 5 for n in range(16)]


@pytest.mark.parametrize(
    ("setting", "value"),
    [
        (of_axis(at.AX_PPU), 1e39),
        (of_axis(at.AX_PPU, not_zero), 0.0),
        (of_axis_long(at.AX_DZU), 2.0**31),
        (of_axis_real(at.AXF_HLDEC_UPS2, not_negative), -0.5),
        (of_axis_real(at.AXF_HLDEC_UPS2), float("inf")),
        (of_axis_real(at.AXF_HLDEC_UPS2), float("nan")),
        (of_master(at.MA_USER_VELOCITY), -1.0),
        (settings.ENCODER_MULTIPLIER, 3.0),
        (settings.ENCODER_MULTIPLIER, 1.5),
    ],
)
def test_a_value_that_cannot_be_is_refused_and_not_stored(
    setting: settings.Setting, value: float
) -> None:
    card = Card()
    before = card.memory.digest()
    with pytest.raises(CardError, match=r"^Invalid argument$"):
        setting.write(card, 1, value)
    assert card.memory.digest() == before


def test_slave_max_velocity_follows_the_axes_of_the_master() -> None:
    card = Card()
    attach.master(card, 0, 0)
    attach.slave(card, 0, 0, 4, "X")
    settings.set_max_velocity(card, 5, 3.0)
    assert not card.memory.bit(SLAVE_MAX_VEL)
    settings.set_max_velocity(card, 4, 3.0)
    assert card.memory.bit(SLAVE_MAX_VEL)
    settings.set_max_velocity(card, 4, 0.0)
    assert not card.memory.bit(SLAVE_MAX_VEL)


@pytest.mark.parametrize(("wanted", "size"), [(0, 1), (1, 2), (5, 32), (9, 32), (-3, 1)])
def test_derivative_smoothing_averages_over_a_power_of_two(wanted: int, size: int) -> None:
    card = Card()
    settings.activate_derivative_smoothing(card, 0)
    card.memory.write(12402, wanted)
    settings.activate_derivative_smoothing(card, 0)
    assert max(1, card.memory.I[at.AXI_BASE + at.AXI_DERIVATIVE_SMOOTH]) == size
