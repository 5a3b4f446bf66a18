"""Settings of compensation: side of the tool, tolerances, the receiver of findings."""

from __future__ import annotations

from collections.abc import Callable
from enum import Enum

from msgspec import Struct

from openacr.cnc.geometry.elements import Element

Report = Callable[[str, str, Element], None]
"""Takes a finding: its code, its text, and the element it is about."""


class Side(Enum):
    """The side of the contour the tool is on, seen in the direction of travel."""

    LEFT = "G41"
    RIGHT = "G42"


class Rules(Struct, frozen=True):
    """The tolerances of system parameters 250101..250103, and Gouge Stop (P250130)."""

    epsilon: float = 0.002  # ends closer than this are joined; units of length
    sweep_epsilon: float = 0.01  # the smallest arc, radians
    root_epsilon: int = -4  # exponent of ten: negative squares that count as 0
    gouge_stop: bool = True  # elements that cannot be reached are errors
    has_entry_arcs: bool = False  # the lead-in may be an arc

    @property
    def root(self) -> float:
        """The square below which circles do not cross."""
        return 10.0**self.root_epsilon
