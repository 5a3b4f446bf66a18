"""The flags and parameters ESAVE keeps that no command sets.

A limit, homing or drive set-up is made of commands and of flags beside them: kept are all of
them or the machine comes back with half of it. States (a latch, a kill, Drive Enabled) are not.
"""

from __future__ import annotations

from collections.abc import Iterator

from openacr.basic.memory.saving import Saved, each
from openacr.map import numbers as at
from openacr.map.rows import axes, masters
from openacr.map.words import af4, af5, mc1
from openacr.motion.axis import settings
from openacr.motion.axis.settings import Setting
from openacr.motion.card import Card

_DRIVE = (
    af4.DRIVE_FAULT_LEVEL_INVERT
    | af4.STEP_DIRECTION_OUTPUT
    | af4.DRIVE_I_O_ENABLE
    | af4.EXC_RESPONSE_ENABLE
    | af4.DISABLE_DRIVE_ON_EXC_ONLY
    | af4.DISABLE_DRIVE_ON_KILL
)
_LIMITS = (
    af5.POSITIVE_LIMIT_LEVEL_INVERT
    | af5.NEGATIVE_LIMIT_LEVEL_INVERT
    | af5.HOME_LEVEL_INVERT
    | af5.HOME_BACKUP_ENABLE
    | af5.HOME_NEGATIVE_EDGE_SELECT
    | af5.HOME_NEGATIVE_FINAL_DIRECTION
)


def saved_beside_commands() -> Iterator[Saved]:
    """Flags under the first one of their word, parameters under their first number."""
    yield _flags("BIT8448", af4.word, _DRIVE)
    yield _flags("BIT16128", af5.word, _LIMITS)
    yield _flags("BIT5632", (at.W_MISC_CONTROL_1,), mc1.FORCE_LINE_NUMBERS_WITH_LIST)
    yield _axes("P12370", settings.fp32(axes.rpm_factor))
    yield _axes("P12376", settings.fp32(axes.lock_feedback_gain))
    yield _axes("P12401", settings.long(axes.cam_velocity_smooth))
    yield _axes("P12402", settings.long(axes.dgain_smooth))
    period = settings.long(masters.int_response_period)
    yield each("P8211", lambda card: card.model.masters, period.read, period.write)


def _axes(words: str, place: Setting) -> Saved:
    return each(words, lambda card: card.model.axes, place.read, place.write)


def _flags(words: str, places: tuple[int, ...], mask: int) -> Saved:
    """The flags of `mask` in one word, or in that of each axis; the others stay as they are."""

    def read(card: Card, number: int) -> int:
        return card.memory.I[places[number]] & mask

    def write(card: Card, number: int, flags: int) -> None:
        kept = card.memory.I[places[number]] & ~mask
        card.memory.I[places[number]] = kept | (flags & mask)

    return each(words, lambda card: min(card.model.axes, len(places)), read, write)
