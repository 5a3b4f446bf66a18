"""Rules of a sweep file beyond the types of single keys: which keys belong together."""

from __future__ import annotations

import keyword
import math
import re
from collections.abc import Iterator

from openacr.errors import UserError
from openacr.plant.describe.complaint import Complaint
from openacr.sweep.expressions import FUNCTIONS, Measure, Needs
from openacr.sweep.results import FIXED
from openacr.sweep.schema import (
    NAME,
    TARGETS,
    VALUES,
    Design,
    Head,
    Kind,
    Quantity,
    Scale,
    Tables,
)

MOST_RUNS = 10_000_000
_NAME = re.compile(NAME)
_TAKEN = frozenset((*FUNCTIONS, *FIXED, "time", "end_time", "run"))


def problems(found: Head, tables: Tables) -> Iterator[Complaint]:
    """Everything that does not fit together."""
    for table in ("vary", "measures"):
        names = getattr(tables, table)
        if not names:
            yield Complaint((table,), f"[{table}] is empty; a sweep needs at least one entry")
        for name in names:
            yield from _name(name, table)
    for name in tables.vary.keys() & tables.measures.keys():
        yield Complaint(
            ("measures", name), f"{name} is a quantity and a measure; a name has one meaning"
        )
    for name, quantity in tables.vary.items():
        yield from _quantity(name, quantity)
    yield from _measures(tables)
    if found.optimise is not None:
        yield from _optimise(found, tables)
    else:
        yield from _design(tables.vary, found.design or Design())


def _name(name: str, table: str) -> Iterator[Complaint]:
    if not _NAME.fullmatch(name) or keyword.iskeyword(name):
        hint = "small letters, digits and _, a letter first, at most 40"
        yield Complaint((table, name), f"{name!r} cannot be a name", hint)
    elif name in _TAKEN:
        yield Complaint(
            (table, name), f"{name} means something else in a sweep; choose another name"
        )


def _one_of(name: str, quantity: Quantity, keys: tuple[str, ...]) -> Iterator[Complaint]:
    given = [key for key in keys if getattr(quantity, key) is not None]
    if len(given) != 1:
        has = " and ".join(given) or "none of them"
        yield Complaint(("vary", name), f"{name} needs one of {', '.join(keys)}; it has {has}")


def _quantity(name: str, quantity: Quantity) -> Iterator[Complaint]:
    place = ("vary", name)
    yield from _one_of(name, quantity, TARGETS)
    yield from _one_of(name, quantity, VALUES)
    if quantity.line is not None and "{}" not in quantity.line:
        yield Complaint(
            (*place, "line"), f'{name}: the line has no {{}} for the value: "AXIS0 PGAIN {{}}"'
        )
    if quantity.values == ():
        yield Complaint((*place, "values"), f"{name}: values is empty")
    if quantity.range is not None:
        low, high = quantity.range
        if not low < high:
            yield Complaint(
                (*place, "range"),
                f"{name}: range is [{low:g}, {high:g}]; the first value must be lower",
            )
        elif quantity.scale is Scale.LOG and low <= 0.0:
            yield Complaint(
                (*place, "range"),
                f'{name}: range begins at {low:g}; with scale = "log" it must be above 0',
            )
    elif quantity.scale is Scale.LOG:
        yield Complaint((*place, "scale"), f"{name}: scale belongs to range")
    if quantity.normal is not None and quantity.normal[1] <= 0.0:
        yield Complaint(
            (*place, "normal"),
            f"{name}: normal is [mean, sigma]; sigma is {quantity.normal[1]:g}, it must be above 0",
        )
    if quantity.steps is not None and quantity.range is None:
        yield Complaint((*place, "steps"), f"{name}: steps belongs to range")


def _measures(found: Tables) -> Iterator[Complaint]:
    names = set(found.vary)
    for name, text in found.measures.items():
        try:
            Measure(text, frozenset(names), Needs())
        except UserError as error:
            yield Complaint(("measures", name), f"{name}: {error}")
        names.add(name)


def _optimise(found: Head, tables: Tables) -> Iterator[Complaint]:
    optimise = found.optimise
    if optimise is None:
        return
    if found.design is not None:
        yield Complaint(("design",), "[design] and [optimise] exclude each other")
    given = [name for name in (optimise.minimise, optimise.maximise) if name is not None]
    if len(given) != 1:
        yield Complaint(("optimise",), "[optimise] needs one of minimise, maximise")
    elif given[0] not in tables.measures:
        key = "minimise" if optimise.minimise is not None else "maximise"
        known = ", ".join(tables.measures)
        yield Complaint(("optimise", key), f"{key} is {given[0]!r}; it must be a measure: {known}")
    for name, quantity in tables.vary.items():
        if quantity.normal is not None:
            yield Complaint(
                ("vary", name, "normal"), f"{name}: a search needs bounds: range or values"
            )
        if quantity.steps is not None:
            yield Complaint(("vary", name, "steps"), f"{name}: a search has no steps")


def _design(vary: dict[str, Quantity], design: Design) -> Iterator[Complaint]:
    if design.kind in (Kind.GRID, Kind.LIST):
        yield from _stepped(vary, design)
        return
    for name, quantity in vary.items():
        if quantity.steps is not None:
            yield Complaint(("vary", name, "steps"), f"{name}: steps are for grid and list")
    samples = design.samples
    if samples is None:
        yield Complaint(("design",), f'kind = "{design.kind}" needs samples')
    elif design.kind is Kind.SOBOL and (samples & (samples - 1) or samples < 2):
        yield Complaint(
            ("design", "samples"),
            f"samples is {samples}; of sobol it must be a power of 2 from 2 on",
        )
    elif design.kind is Kind.SOBOL and samples * (len(vary) + 2) > MOST_RUNS:
        yield Complaint(
            ("design", "samples"), f"{samples * (len(vary) + 2)} runs; at most {MOST_RUNS}"
        )


def _stepped(vary: dict[str, Quantity], design: Design) -> Iterator[Complaint]:
    if design.samples is not None:
        yield Complaint(("design", "samples"), "samples is for random and sobol")
    for name, quantity in vary.items():
        if quantity.normal is not None:
            yield Complaint(("vary", name, "normal"), f"{name}: normal is for random and sobol")
        if quantity.range is not None and quantity.steps is None:
            yield Complaint(
                ("vary", name, "range"), f"{name}: a range in a {design.kind} needs steps"
            )
    lengths = {name: _length(quantity) for name, quantity in vary.items()}
    if design.kind is Kind.GRID and math.prod(lengths.values()) > MOST_RUNS:
        yield Complaint(("vary",), f"{math.prod(lengths.values())} runs; at most {MOST_RUNS}")
    if design.kind is Kind.LIST and len(set(lengths.values())) > 1:
        found = ", ".join(f"{name} {count}" for name, count in lengths.items())
        yield Complaint(
            ("vary",), f"the quantities of a list have as many values each; found: {found}"
        )


def _length(quantity: Quantity) -> int:
    return quantity.steps or (len(quantity.values) if quantity.values else 1)
