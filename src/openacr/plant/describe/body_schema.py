"""The drawing part of a `machine.toml`: the body that an axis moves, in millimetres."""

from typing import Annotated

from msgspec import Meta, Struct

Millimetres = Annotated[float, Meta(ge=-1e6, le=1e6)]
Size = Annotated[float, Meta(gt=0, le=1e6)]
Component = Annotated[float, Meta(ge=-1, le=1)]
PerUnit = Annotated[float, Meta(gt=0, le=1e6)]
Vector = tuple[Component, Component, Component]
Place = tuple[Millimetres, Millimetres, Millimetres]
Sides = tuple[Size, Size, Size]


class Body(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """How an axis is drawn: where it is, what it moves, what carries it."""

    rotary: bool | None = None
    direction: Vector | None = None  # of positive motion; of a rotary axis: its axis of rotation
    parent: str | None = None  # the axis that carries it; "": the ground
    origin: Place | None = None  # where position 0 is, from position 0 of the parent
    per_unit: PerUnit | None = None  # mm or degrees in a unit of the axis
    size: Sides | None = None
    at: Place = (0.0, 0.0, 0.0)  # the middle of the box, or the zero of the file
    colour: str = ""
    file: str = ""


class Sign(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """Where a device is drawn: on the ground, or on an axis."""

    at: Place
    parent: str = ""
