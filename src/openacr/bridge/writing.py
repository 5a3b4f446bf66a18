"""Writing of values that the bridge file lists: limits first, then as any host writes."""

import asyncio
import logging
import math

from openacr.bridge.feed import Feed
from openacr.bridge.items import Item
from openacr.bridge.settings import Chosen
from openacr.errors import OpenacrError, UserError
from openacr.map import parameters
from openacr.map.block import Kind

log = logging.getLogger(__name__)
WRITE_S = 3.0  # longest wait for the card


class Writer:
    """Writes values to the machine of a feed."""

    def __init__(self, feed: Feed) -> None:
        self._feed = feed

    async def write(self, item: Item, value: object, source: str) -> None:
        """Set a value; UserError says why it is refused. `source` names the host in the log."""
        chosen = item.chosen
        if chosen is None or not chosen.write:
            raise UserError(f"{item.name} cannot be written: the bridge file does not allow it")
        number = checked(chosen, value)
        done = self._feed.write(chosen.number, number, is_flag=chosen.is_flag)
        try:
            async with asyncio.timeout(WRITE_S):
                await asyncio.wrap_future(done)
        except TimeoutError:
            raise UserError(f"{item.name}: the card has not answered in {WRITE_S:g} s") from None
        except OpenacrError as error:
            raise UserError(f"{item.name}: {error}") from None
        log.info("%s was set to %g by %s", item.name, number, source)


class RangeError(UserError):
    """A value beyond its limits."""


class KindError(UserError):
    """A value of another kind: a text, or a flag for a number."""


def checked(chosen: Chosen, value: object) -> float:
    """The number to write; KindError for another kind of value, RangeError beyond its limits."""
    if chosen.is_flag:
        if not isinstance(value, bool | int | float):
            raise KindError(f"{chosen.name} is a flag: {value!r} is neither 0 nor 1")
        if value not in (0, 1):
            raise RangeError(f"{chosen.name} is a flag: {value!r} is neither 0 nor 1")
        return float(value)
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise KindError(f"{chosen.name}: {value!r} is not a number")
    if not math.isfinite(value):
        raise RangeError(f"{chosen.name}: {value!r} is not a number")
    low, high = chosen.low, chosen.high
    if low is None or high is None or not low <= value <= high:
        raise RangeError(f"{chosen.name}: {value:g} is not in {low:g}..{high:g}")
    known = parameters().get(chosen.number)
    if known is not None and known.kind is Kind.LONG and value != int(value):
        raise RangeError(f"{chosen.name} is a whole number: {value:g} is not")
    return float(value)
