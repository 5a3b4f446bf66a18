"""The schema of a sweep file: what is varied, by which design, and what is measured."""

from enum import StrEnum
from typing import Annotated, Any

from msgspec import Meta, Struct, defstruct, structs

Seconds = Annotated[float, Meta(gt=0, le=1e7)]
Count = Annotated[int, Meta(ge=1, le=10_000_000)]
Steps = Annotated[int, Meta(ge=2, le=1_000_000)]
Seed = Annotated[int, Meta(ge=0, le=2**32 - 1)]
NAME = r"[a-z][a-z0-9_]{0,39}"


class Kind(StrEnum):
    """How the values of several quantities are put together."""

    GRID = "grid"
    LIST = "list"
    RANDOM = "random"
    SOBOL = "sobol"


class Scale(StrEnum):
    """How a range is divided."""

    LINEAR = "linear"
    LOG = "log"


class _Table(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """A table of the file: unknown keys are errors."""


class Quantity(_Table, frozen=True):
    """A quantity that is varied: where its value goes, and the values it takes."""

    machine: str | tuple[str, ...] | None = None
    parameter: int | None = None
    define: str | None = None
    line: str | None = None
    values: tuple[float, ...] | None = None
    range: tuple[float, float] | None = None
    steps: Steps | None = None
    scale: Scale = Scale.LINEAR
    normal: tuple[float, float] | None = None


TARGETS = ("machine", "parameter", "define", "line")
VALUES = ("values", "range", "normal")


class Design(_Table, frozen=True):
    """Which combinations of values are run."""

    kind: Kind = Kind.GRID
    samples: Count | None = None
    seed: Seed = 1


class Optimise(_Table, frozen=True):
    """The search for the least (or greatest) value of a measure."""

    minimise: str | None = None
    maximise: str | None = None
    trials: Count = 100
    seed: Seed = 1


# Of each of these sets an entry has exactly one key.
EXACTLY_ONE: dict[type[Struct], tuple[tuple[str, ...], ...]] = {
    Quantity: (TARGETS, VALUES),
    Optimise: (("minimise", "maximise"),),
}


class Head(_Table, frozen=True, kw_only=True):
    """A sweep without the tables whose keys are names of the user."""

    project: str
    scenario: str | None = None
    duration_s: Seconds | None = None
    until: str | int | None = None
    every_tk: Annotated[int, Meta(ge=1, le=1_000_000)] = 1
    design: Design | None = None
    optimise: Optimise | None = None


class Tables(Struct, frozen=True):
    """The tables whose keys are names of the user."""

    vary: dict[str, Quantity]
    measures: dict[str, str]


_NAMED: dict[str, type] = {"vary": Quantity, "measures": str}


def kind_for_editors() -> Any:
    """The type of any sweep file, with the rule for names, as its JSON schema is made of it."""
    name = Annotated[str, Meta(pattern=f"^{NAME}$")]
    fields = [
        (table, Annotated[dict[name, kind], Meta(min_length=1)])  # type: ignore[valid-type]
        for table, kind in _NAMED.items()
    ]
    return defstruct("SweepFile", fields, bases=(Head,), frozen=True, kw_only=True)


def kind_for(raw: dict[str, Any]) -> type[Head]:
    """The type of a sweep file with these names, so that every mistake has its whole path."""
    fields: list[tuple[str, type]] = []
    for table, kind in _NAMED.items():
        given = raw.get(table)
        names = list(given) if isinstance(given, dict) else []
        places = {f"at{k}": name for k, name in enumerate(names)}
        members = [(place, kind) for place in places]
        made = defstruct(table, members, rename=places, frozen=True, forbid_unknown_fields=True)
        fields.append((table, made))
    found: Any = defstruct("SweepFile", fields, bases=(Head,), frozen=True, kw_only=True)
    return found  # type: ignore[no-any-return]


def tables_of(found: Any) -> Tables:
    """The tables of a file that was converted to `kind_for` it."""
    vary, measures = (
        {field.encode_name: getattr(table, field.name) for field in structs.fields(table)}
        for table in (found.vary, found.measures)
    )
    return Tables(vary, measures)
