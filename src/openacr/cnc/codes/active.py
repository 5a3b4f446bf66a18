"""What stays active between blocks beside the modal state: a canned cycle, a modal macro ..."""

from __future__ import annotations

from msgspec import Struct, field

from openacr.cnc.canonical import Point
from openacr.cnc.program.program import Node
from openacr.cnc.state.modal import Modal


class Drilling(Struct):
    """The words of cycle blocks since the last G80: lengths in default units."""

    initial: float = 0.0
    level: tuple[float, bool] | None = None  # R, and whether it counts from the initial level
    bottom: tuple[float, bool] | None = None  # Z, and whether it counts from R
    words: dict[str, float] = field(default_factory=dict)  # Q, P

    @property
    def levels(self) -> tuple[float, float]:
        """R level and bottom."""
        r, is_from_initial = self.level or (0.0, False)
        r = r + self.initial if is_from_initial else r
        b, is_from_r = self.bottom or (0.0, False)
        return r, b + r if is_from_r else b


class Curve(Struct):
    """Splines: the control points since G5.2, and how the last G5 ended; default units."""

    points: list[tuple[float, float]] = field(default_factory=list)
    weights: list[float] = field(default_factory=list)
    order: int = 3
    end: Point | None = None  # the program point where the last G5 ended
    onward: tuple[float, float] = (0.0, 0.0)  # I and J of a G5 that continues it


class ModalMacro(Struct, frozen=True):
    """G66: what is called after every block that has moved."""

    start: Node
    values: tuple[float, ...]
    repeat_cnt: int


class Context(Struct, frozen=True):
    """What M70 keeps; `is_automatic` (M73): restored when the subroutine returns."""

    modal: Modal
    added: Point
    is_automatic: bool
