"""What Drive Talk needs of drives that are not modelled."""

from __future__ import annotations

from typing import Protocol


class RealDrives(Protocol):
    """Drives on serial lines of the computer, by the axes of the card. No call waits."""

    def begin(self, port: int, axis: int, text: str, *, baud: int, bits: int, alone: bool) -> bool:
        """Send a line of text over a port of the card; False if the drive of the axis is modelled.

        `baud` and `bits` of a character as the program has opened the port. `alone`: only the
        drive of this axis may hear it.
        """

    def answers(self, axis: int) -> list[str] | None:
        """What drives have answered, one text each; None while an answer is waited for."""
