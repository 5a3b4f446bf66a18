"""What a debugger shows of a program: its variables, its state, its axes."""

from __future__ import annotations

from collections.abc import Iterator
from struct import iter_unpack

from openacr.basic.memory.heap import ARRAYS, SCALARS
from openacr.client.program_variables import Value
from openacr.controller.controller import Controller
from openacr.debugger.calls import levels_of, state_of

_FORMATS = {"LV": "i", "SV": "f", "DV": "d", "LA": "i", "SA": "f", "DA": "d"}


def locals_of(card: Controller, program: int) -> Iterator[Value]:
    """The variables and arrays that a program has dimensioned."""
    storage = card.system.storage
    for kind in SCALARS:
        for place, text in enumerate(_texts(kind.name, storage.heap.scalars(program, kind))):
            yield Value(f"{kind.name}{place}", text)
    for table in ARRAYS:
        for place, held in enumerate(storage.heap.elements(program, table)):
            if held:
                yield _array(f"{table.name}{place}", list(_texts(table.name, held)))
    strings = storage.locals.strings[program]
    if strings.variables is not None:
        for place, text in enumerate(strings.variables.values):
            yield Value(f"$V{place}", repr(text))
    for place, block in enumerate(strings.arrays):
        if block is not None:
            yield _array(f"$A{place}", [repr(text) for text in block.values])


def _texts(kind: str, held: bytes) -> Iterator[str]:
    """Numbers of a kind of variable as they are in memory."""
    for (number,) in iter_unpack(f"<{_FORMATS[kind]}", held):
        yield f"{number:.9g}"


def _array(name: str, texts: list[str]) -> Value:
    elements = tuple(Value(f"{name}({place})", text) for place, text in enumerate(texts))
    return Value(name, f"{len(texts)} elements", elements)


def program_state(card: Controller, program: int) -> Iterator[Value]:
    """What a program does, and since when the card runs."""
    yield Value("state", state_of(card, program))
    levels = levels_of(card, program)
    if levels:
        yield Value("levels", ", ".join(map(str, levels)))
    failure = card.executor.threads.failures.get(program)
    if failure is not None:
        yield Value("error", failure)


def time_state(card: Controller) -> Iterator[Value]:
    """The present moment."""
    yield Value("tick", str(card.lived_tk))
    yield Value("time", f"{card.lived_tk * card.period_s:.6f} s")
    if card.within:
        yield Value("before statement", f"{card.within} of this tick")


def axis_states(card: Controller, program: int) -> Iterator[Value]:
    """The axes attached to a program: positions [units], velocity [units/s], error [counts]."""
    for name, number in card.card.attachments.axes(program):
        axis = card.axis(number)
        parts = {
            "commanded": axis.commanded_u,
            "actual": axis.actual_u,
            "velocity": axis.velocity_ups,
            "following error (counts)": axis.following_error,
        }
        elements = tuple(Value(part, f"{value:.9g}") for part, value in parts.items())
        yield Value(f"{name} (AXIS{number})", f"{axis.actual_u:.9g}", elements)
