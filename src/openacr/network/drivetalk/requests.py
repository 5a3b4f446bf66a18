"""The lines a card sends to a drive for each request, and the use of the answers."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial

from openacr.map.memory import Memory
from openacr.map.rows import drive_talk
from openacr.map.tables.drivetalk import (
    CONFIGURATION,
    FIRST_ITEM,
    FIRST_ITEM_FLAG,
    FIRST_SETTING,
    STATUS_ITEMS,
)
from openacr.map.words import dtcf, dtef, dts1, dts2
from openacr.plant.bus.aries_port import WORD_BITS, bits_of, number_text

ARIES_TYPE = 0
Take = Callable[[str], bool]


@dataclass(frozen=True, slots=True)
class Exchange:
    """A line for a drive; `take` returns whether the answer is as expected."""

    text: str
    take: Take
    on_connector: bool = False


def address(axis: int) -> int:
    """The address of the drive of an axis; 0 is the address of drives that have none."""
    return axis + 1


def exchanges(memory: Memory, axis: int, request: int, selection: int) -> list[Exchange]:
    """Everything one request of an axis needs."""
    return list(_MAKERS[request](memory, axis, selection))


def _anything(answer: str) -> bool:
    return True


def _auto_address(memory: Memory, axis: int, selection: int) -> Iterator[Exchange]:
    own = address(axis)
    yield Exchange(f"ADDR{own}", _anything, on_connector=True)
    yield Exchange(f"{own}_ADDR", lambda answer: answer.strip() == f"*{own}")


def _get_configuration(memory: Memory, axis: int, selection: int) -> Iterator[Exchange]:
    for row, (word, _) in enumerate(CONFIGURATION, FIRST_SETTING):
        yield _ask(memory, axis, word, row)


def _send_configuration(memory: Memory, axis: int, selection: int) -> Iterator[Exchange]:
    for row, (word, _) in enumerate(CONFIGURATION, FIRST_SETTING):
        value = number_text(memory.S[_parameter(axis, row)])
        yield Exchange(f"{address(axis)}_{word}{value}", _anything)


def _send_selection(memory: Memory, axis: int, selection: int) -> Iterator[Exchange]:
    bits = memory.I[dtef.word[axis]]
    digits = "".join(str(bits >> bit & 1) for bit in range(WORD_BITS))
    yield Exchange(f"{address(axis)}_ERRORL{digits}", _anything)


def _get_data(memory: Memory, axis: int, selection: int) -> Iterator[Exchange]:
    for place, (word, _) in enumerate(STATUS_ITEMS):
        if selection >> (FIRST_ITEM_FLAG + place) & 1:
            yield _ask(memory, axis, word, FIRST_ITEM + place)
    for mask, word, first in (
        (dtcf.DRIVE_STATUS_1_SELECT, "TAS", dts1.word),
        (dtcf.DRIVE_STATUS_2_SELECT, "TASX", dts2.word),
    ):
        if selection & mask:
            take = partial(_take_bits, memory, first[axis])
            yield Exchange(f"{address(axis)}_{word}", take)


_MAKERS: dict[int, Callable[[Memory, int, int], Iterator[Exchange]]] = {
    dtcf.AUTO_ADDRESS_REQUEST: _auto_address,
    dtcf.GET_CONFIGURATION_REQUEST: _get_configuration,
    dtcf.SEND_CONFIGURATION_REQUEST: _send_configuration,
    dtcf.SEND_ERRORL_REQUEST: _send_selection,
    dtcf.GET_DRIVE_DATA_REQUEST: _get_data,
}


def _ask(memory: Memory, axis: int, word: str, row: int) -> Exchange:
    return Exchange(f"{address(axis)}_{word}", partial(_take_number, memory, _parameter(axis, row)))


def _parameter(axis: int, row: int) -> int:
    return drive_talk.parameters[axis] + row


def _take_number(memory: Memory, parameter: int, answer: str) -> bool:
    """Store a value; an answer without one changes nothing."""
    try:
        memory.write(parameter, float(answer.strip().removeprefix("*")))
    except ValueError:
        return False
    return True


def _take_bits(memory: Memory, word: int, answer: str) -> bool:
    bits = bits_of(answer.strip().removeprefix("*"))
    if bits is None:
        return False
    memory.I[word] = bits if bits < 2**31 else bits - 2**32
    return True
