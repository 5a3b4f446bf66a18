"""What a debugger shows of a program: its variables, its state, its axes."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from struct import calcsize, iter_unpack

from openacr.basic.memory.heap import ARRAYS, SCALARS
from openacr.client.program_variables import LOCAL, Value
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


def local_text(card: Controller, program: int, name: str) -> str | None:
    """The value of `LV0` or `SA1(3)` of a program; None while it is not dimensioned."""
    found = LOCAL.fullmatch(name)
    if found is None:
        return None
    owner, at = found[1], int(found[2])
    kind, array = owner[:2], int(owner[2:] or 0)
    if kind.startswith("$"):
        strings = card.system.storage.locals.strings[program]
        block = strings.variables if kind == "$V" else dict(enumerate(strings.arrays)).get(array)
        return repr(block.values[at]) if block and at < len(block.values) else None
    held, size = _held(card, program, kind, array), calcsize(f"<{_FORMATS[kind]}")
    texts = list(_texts(kind, held[at * size : (at + 1) * size]))
    return texts[0] if texts else None


def _held(card: Controller, program: int, kind: str, array: int) -> bytes:
    """Variables of a kind, or the elements of an array, as they are in memory."""
    heap = card.system.storage.heap
    for scalar in SCALARS:
        if scalar.name == kind:
            return heap.scalars(program, scalar)
    table = next(each for each in ARRAYS if each.name == kind)
    return next(islice(heap.elements(program, table), array, None), b"")


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
