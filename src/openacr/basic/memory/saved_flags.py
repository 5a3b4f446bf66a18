"""The flags and parameters ESAVE keeps that no command sets.

A limit, homing or drive set-up is made of commands and of flags beside them: kept are all of
them or the machine comes back with half of it. States (a latch, a kill, Drive Enabled) are not.
"""

from __future__ import annotations

from collections.abc import Iterator

from openacr.basic.memory.saving import Saved, each
from openacr.map import numbers as at
from openacr.map.block import Kind
from openacr.motion.axis import settings
from openacr.motion.axis.settings import Setting
from openacr.motion.card import Card

_DRIVE = (
    at.AF4_DRIVE_FAULT_LEVEL_INVERT
    | at.AF4_STEP_DIRECTION_OUTPUT
    | at.AF4_DRIVE_I_O_ENABLE
    | at.AF4_EXC_RESPONSE_ENABLE
    | at.AF4_DISABLE_DRIVE_ON_EXC_ONLY
    | at.AF4_DISABLE_DRIVE_ON_KILL
)
_LIMITS = (
    at.AF5_POSITIVE_LIMIT_LEVEL_INVERT
    | at.AF5_NEGATIVE_LIMIT_LEVEL_INVERT
    | at.AF5_HOME_LEVEL_INVERT
    | at.AF5_HOME_BACKUP_ENABLE
    | at.AF5_HOME_NEGATIVE_EDGE_SELECT
    | at.AF5_HOME_NEGATIVE_FINAL_DIRECTION
)


def saved_beside_commands() -> Iterator[Saved]:
    """Flags under the first one of their word, parameters under their first number."""
    yield _flags("BIT8448", at.AF4_WORD, _DRIVE, of_axes=True)
    yield _flags("BIT16128", at.AF5_WORD, _LIMITS, of_axes=True)
    yield _flags("BIT5632", at.W_MISC_CONTROL_1, at.MC1_FORCE_LINE_NUMBERS_WITH_LIST)
    yield _axes("P12370", settings.of_axis(at.AX_RPM_FACTOR))
    yield _axes("P12376", settings.of_axis(at.AX_LOCK_FEEDBACK_GAIN))
    yield _axes("P12401", settings.of_axis_long(at.AX_CAM_VELOCITY_SMOOTH))
    yield _axes("P12402", settings.of_axis_long(at.AX_DGAIN_SMOOTH))
    period = Setting(Kind.LONG, at.MA_BASE + at.MA_INT_RESPONSE_PERIOD, at.MA_STRIDE)
    yield each("P8211", lambda card: card.model.masters, period.read, period.write)


def _axes(words: str, place: Setting) -> Saved:
    return each(words, lambda card: card.model.axes, place.read, place.write)


def _flags(words: str, first: int, mask: int, of_axes: bool = False) -> Saved:
    """The flags of `mask` in one word, or in that of each axis; the others stay as they are."""

    def read(card: Card, number: int) -> int:
        return card.memory.I[first + number] & mask

    def write(card: Card, number: int, flags: int) -> None:
        kept = card.memory.I[first + number] & ~mask
        card.memory.I[first + number] = kept | (flags & mask)

    return each(words, lambda card: card.model.axes if of_axes else 1, read, write)
