"""Where a bridge gets its moments from."""

from concurrent.futures import Future
from typing import Protocol

from openacr.bridge.moment import AxisName, Moment

STALE_S = 2.0  # a reading that is older is no longer published


class Feed(Protocol):
    """A source of moments. `newest` and `write` never wait for the card."""

    @property
    def axes(self) -> tuple[AxisName, ...]:
        """The axes of the machine, in the order of positions."""

    def start(self, parameters: list[int], rate_hz: float) -> None:
        """Begin to read, with these parameters of the card as well."""

    def newest(self) -> Moment:
        """The newest reading."""

    def write(self, number: int, value: float, *, is_flag: bool) -> "Future[None]":
        """Set a parameter or flag as the client does; the error of the card is in the future."""

    def stop(self) -> None:
        """End reading."""
