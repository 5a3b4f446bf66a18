"""Where the value of a quantity goes: machine.toml, a define, a parameter, a typed line."""

from __future__ import annotations

import re
from copy import deepcopy
from typing import Any

from msgspec.structs import replace

from openacr.errors import CardError, MapError, SourceError, UserError
from openacr.plant.describe import schema, toml_file
from openacr.plant.describe.load import build_world
from openacr.project import Project, SourceFile
from openacr.sweep.schema import Quantity
from openacr.sweep.study import Point, Study

_STEP = re.compile(r"([A-Za-z_][A-Za-z0-9_]*)(?:\[(\d+)\])?")
_AXIS = re.compile(r"AXIS(\d+)")
_NO_PLACE = "is no place in a machine; AXIS0.load.inertia_kgm2 is one"


def number(value: float) -> str:
    """A value as it is written in a program: a whole one without a point."""
    return str(int(value)) if value == int(value) and abs(value) < 1e15 else repr(value)


def is_loaded(quantity: Quantity) -> bool:
    """Whether a value acts when the project is loaded, and not when the run begins."""
    return quantity.machine is not None or quantity.define is not None


def world_of(study: Study, point: Point) -> schema.World | None:
    """The machine with the values of a point; None: the project has no machine file.

    SourceError for a value that the machine cannot have.
    """
    if study.machine is None:
        return None
    raw = deepcopy(toml_file.parse(study.machine, study.machine_path))
    for (name, quantity), value in zip(study.quantities.items(), point, strict=True):
        paths = (quantity.machine,) if isinstance(quantity.machine, str) else quantity.machine
        for path in paths or ():
            _put(raw, path, value, name)
    world, complaints = build_world(raw)
    for complaint in complaints:
        raise SourceError(complaint.text, path=study.machine_path, hint=complaint.hint)
    return world


def _put(raw: dict[str, Any], path: str, value: float, name: str) -> None:
    """Put a value at `AXIS0.load.inertia_kgm2`, `wire[0].at` or `card.period_s`."""
    table: Any = raw
    *steps, last = path.split(".")
    for place, text in enumerate(steps):
        if place == 0 and (axis := _AXIS.fullmatch(text)):
            table = _axis(raw, int(axis[1]), name)
            continue
        table = _inner(table, text, name, path)
    key = _STEP.fullmatch(last)
    if key is None or not isinstance(table, dict) or not steps:
        raise UserError(f"{name}: {path!r} {_NO_PLACE}")
    present = table.get(key[1])
    if key[2] is not None:
        if not isinstance(present, list) or int(key[2]) >= len(present):
            raise UserError(f"{name}: {path!r}: the machine has no {last}")
        present[int(key[2])] = _typed(value)
    else:
        table[key[1]] = _typed(value)


def _typed(value: float) -> float | int:
    """Whole values as whole numbers: keys that count refuse others, and all others take both."""
    return int(value) if value == int(value) else value


def _axis(raw: dict[str, Any], wanted: int, name: str) -> dict[str, Any]:
    axes: list[dict[str, Any]] = raw.get("axis", [])
    for axis in axes:
        if axis.get("number") == wanted:
            return axis
    known = ", ".join(f"AXIS{axis.get('number')}" for axis in axes) or "no axes"
    raise UserError(f"{name}: the machine has no AXIS{wanted}; it has {known}")


def _inner(table: Any, text: str, name: str, path: str) -> Any:
    step = _STEP.fullmatch(text)
    if step is None or not isinstance(table, dict):
        raise UserError(f"{name}: {path!r} {_NO_PLACE}")
    found = table.setdefault(step[1], {})
    if step[2] is None:
        return found
    if not isinstance(found, list) or int(step[2]) >= len(found):
        raise UserError(f"{name}: {path!r}: the machine has no {text}")
    return found[int(step[2])]


def project_of(study: Study, point: Point) -> Project:
    """The project with the defines of a point."""
    project = study.project
    for (name, quantity), value in zip(study.quantities.items(), point, strict=True):
        if quantity.define is not None:
            project = _defined(project, quantity.define, number(value), name)
    return project


def _defined(project: Project, define: str, target: str, name: str) -> Project:
    """The project with another target in each `#DEFINE` of this name; UserError without one."""
    begin, rest = rf"[ \t]*#DEFINE[ \t]+{re.escape(define)}[ \t]+", r"[^\r\n]*"
    pattern = re.compile(rf"^({begin}){rest}", re.IGNORECASE | re.MULTILINE)
    count = 0

    def changed(source: SourceFile) -> SourceFile:
        nonlocal count
        text = source.data.decode("latin-1")  # every byte as it is
        new, hits = pattern.subn(lambda found: f"{found[1]}{target}", text)
        count += hits
        return replace(source, data=new.encode("latin-1")) if hits else source

    project = replace(
        project,
        setup=changed(project.setup) if project.setup else None,
        plcs=tuple(map(changed, project.plcs)),
        programs=tuple(map(changed, project.programs)),
    )
    if not count:
        raise UserError(f"{name}: no file of {project.root} has a line `#DEFINE {define} ...`")
    return project


def typed_of(study: Study, point: Point) -> list[str]:
    """What is typed at SYS when a run begins, in the order of the quantities."""
    return [
        quantity.line.replace("{}", number(value))
        for quantity, value in zip(study.quantities.values(), point, strict=True)
        if quantity.line is not None
    ]


def parameters_of(study: Study, point: Point) -> dict[int, float]:
    """The parameters that are set when a run begins."""
    return {
        quantity.parameter: value
        for quantity, value in zip(study.quantities.values(), point, strict=True)
        if quantity.parameter is not None
    }


def set_parameter(parameters: Any, parameter: int, value: float) -> None:
    """Set a parameter of a card; UserError with its number where that is not possible."""
    try:
        parameters[parameter] = value
    except (CardError, MapError, OverflowError) as error:
        raise UserError(f"P{parameter} = {value:g}: {error}") from None
