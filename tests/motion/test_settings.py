"""Settings: where values lie, what is refused, and what hangs on them."""

import pytest

from openacr.errors import CardError
from openacr.map.rows import axes, masters
from openacr.motion.axis import attach, settings
from openacr.motion.axis.settings import fp32, fp64, long, not_negative, not_zero
from openacr.motion.card import Card

AXIS, MASTER, DZU = 3, 2, 12288 + 3 * 256 + 115
SLAVE_MAX_VEL = 2076


def test_a_setting_with_a_parameter_is_the_parameter() -> None:
    card = Card()
    fp32(axes.ppu).write(card, AXIS, 2.5)
    long(axes.dzu).write(card, AXIS, -7.9)
    fp32(masters.manual_vector).write(card, MASTER, 4.0)
    assert [card.memory.read(number) for number in (13143, DZU, 8714)] == [2.5, -7, 4.0]


@pytest.mark.parametrize(
    "setting",
    [
        fp32(axes.ppu),
        long(axes.dzu),
        fp64(axes.hldec_ups2),
        long(axes.hlbit),
        fp32(masters.manual_vector),
        fp64(masters.jrk_ups3),
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
        (fp32(axes.ppu), 1e39),
        (fp32(axes.ppu, not_zero), 0.0),
        (long(axes.dzu), 2.0**31),
        (fp64(axes.hldec_ups2, not_negative), -0.5),
        (fp64(axes.hldec_ups2), float("inf")),
        (fp64(axes.hldec_ups2), float("nan")),
        (fp32(masters.user_velocity, not_negative), -1.0),
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
    assert max(1, card.memory.I[axes.derivative_smooth[0]]) == size
