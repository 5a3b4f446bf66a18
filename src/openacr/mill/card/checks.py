"""Checks that refuse an unsuitable card: firmware too old, too few axes, or in motion."""

from openacr.client import Card
from openacr.errors import UserError
from openacr.map import numbers as n
from openacr.map.words import af1, mf1
from openacr.mill.card import alarms
from openacr.mill.card.alarms import AlarmError
from openacr.mill.config.settings import Settings
from openacr.models import Model

OLDEST_FIRMWARE = 11800


class MovingError(UserError):
    """The machine moves: its set-up has to wait."""


def check_firmware(card: Card) -> None:
    """Refuse a card whose firmware is too old for move packets."""
    version = int(card.read(n.P_FIRMWARE_VERSION))
    if version < OLDEST_FIRMWARE:
        major, minor, update = version // 10000, version // 100 % 100, version % 100
        raise AlarmError(alarms.OLD_FIRMWARE, f"{major}.{minor:02}.{update:02}")


def check_axes(model: Model, settings: Settings) -> None:
    """Refuse a machine with axes that its card model cannot drive."""
    beyond = [axis.name for axis in settings.axes if axis.index >= model.connected_axes]
    if beyond:
        lacking = f"{model.name}: axis {' '.join(beyond)}, it has {model.connected_axes} axes"
        raise AlarmError(alarms.LACKS_FUNCTION, lacking)


def check_rest(card: Card, settings: Settings) -> None:
    """Refuse a machine in motion: the set-up would interrupt another program."""
    words = [mf1.word[settings.master], *(af1.word[axis.index] for axis in settings.axes)]
    master, *axes = map(int, card.read_many(words))
    is_moving = master & (mf1.IN_MOTION | mf1.MOVE_BUFFERED)
    if is_moving or any(word & af1.JOG_ACTIVE for word in axes):
        raise MovingError("the machine is moving: another program runs it; wait or stop it")
