"""Why the output of an axis is cut, as far as its card tells."""

from typing import TYPE_CHECKING

from openacr.map import numbers as at

if TYPE_CHECKING:
    from openacr.client import Card

LOW_AXES = 8


def why_silent(card: "Card", axis: int) -> str:
    """The reason why an axis that is on puts out nothing; empty while nothing cuts its output."""
    first = at.AF1_WORD if axis < LOW_AXES else at.AF1_WORD_HIGH
    loop, drive = map(int, card.read_many([first + axis, at.AF4_WORD + axis]))
    if loop & at.AF1_OPEN_SERVO_LOOP:
        return "the servo loop is open"
    if loop & at.AF1_CLAMP_OUTPUT_SIGNAL:
        return "the output is clamped"
    if drive & at.AF4_DRIVE_ENABLED:
        return ""
    if drive & at.AF4_DRIVE_I_O_ENABLE:
        return "the drive is not enabled"
    is_driven = any(line.endswith(" DRIVEN") for line in card.command(f"AXIS{axis} DRIVE"))
    return "" if is_driven else "the drive was disabled"
