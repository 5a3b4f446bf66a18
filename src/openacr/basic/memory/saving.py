"""How a command has its values kept by ESAVE: rows by their settings, others by functions."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from msgspec import Struct

from openacr.motion.card import Card

if TYPE_CHECKING:
    from openacr.basic.execute.system import System
    from openacr.motion.axis.settings import Setting

# Commands that show the same value under another name or in another unit.
SAME_VALUE = {"MULT": "ENC # MULT", "F": "VEL", "AXIS # OFF": "AXIS # ON"}


class Saved(Struct, frozen=True):
    """What belongs to one command, as plain data."""

    words: str
    take: Callable[[System], Any]
    put: Callable[[System, Any], None]


kept: dict[str, Saved] = {}


def keep(
    words: str,
    *places: Setting,
    count: Callable[[Card], int],
    then: Callable[[Card, int], None] | None = None,
) -> None:
    """Enter a command whose values are settings of objects 0 to `count` - 1."""
    if words in SAME_VALUE:
        return

    def read(card: Card, number: int) -> list[float]:
        return [place.read(card, number) for place in places]

    def write(card: Card, number: int, row: list[float]) -> None:
        for place, value in zip(places, row, strict=True):
            place.write(card, number, value)
        if then is not None:
            then(card, number)

    kept[words] = each(words, count, read, write)


def each(
    words: str,
    count: Callable[[Card], int],
    read: Callable[[Card, int], Any],
    write: Callable[[Card, int, Any], None],
) -> Saved:
    """A command by functions that give and take the data of one object."""

    def take(system: System) -> list[Any]:
        return [read(system.card, number) for number in range(count(system.card))]

    def put(system: System, values: list[Any]) -> None:
        for number, value in enumerate(values[: count(system.card)]):
            write(system.card, number, value)

    return Saved(words, take, put)
