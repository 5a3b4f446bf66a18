"""Why the output of an axis is cut, as far as its card tells."""

from typing import TYPE_CHECKING

from openacr.map.words import af1, af4

if TYPE_CHECKING:
    from openacr.client import Card


def why_silent(card: "Card", axis: int) -> str:
    """The reason why an axis that is on puts out nothing; empty while nothing cuts its output."""
    loop, drive = map(int, card.read_many([af1.word[axis], af4.word[axis]]))
    if loop & af1.OPEN_SERVO_LOOP:
        return "the servo loop is open"
    if loop & af1.CLAMP_OUTPUT_SIGNAL:
        return "the output is clamped"
    if drive & af4.DRIVE_ENABLED:
        return ""
    if drive & af4.DRIVE_I_O_ENABLE:
        return "the drive is not enabled"
    is_driven = any(line.endswith(" DRIVEN") for line in card.command(f"AXIS{axis} DRIVE"))
    return "" if is_driven else "the drive was disabled"
