"""View of a tool path: colours and directions of the DISPLAY, TOOL and CONTROL tabs."""

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from openacr.mill.config.colors import COLORS, LIGHT_GREEN
from openacr.mill.config.settings import Store
from openacr.sysvar.tabs import CONTROL, DISPLAY, TOOL


@dataclass(frozen=True, slots=True)
class View:
    """View settings; colours are indices of `COLORS`, flips affect only the drawing."""

    has_tool_colors: bool = False
    path_color: int = LIGHT_GREEN
    tool_colors: dict[int, int] = field(default_factory=dict)
    flips_x: bool = False
    flips_y: bool = False
    exchanges: bool = False

    @classmethod
    def of(cls, store: Store, tools: Iterable[int], *, by_tool: bool = False) -> "View":
        """The view configured in the store; `by_tool` forces a colour for each tool."""
        return cls(
            has_tool_colors=by_tool or bool(store.read(DISPLAY.color_via_d_codes)),
            path_color=int(store.read(CONTROL.path_color)),
            tool_colors={n: int(store.read(TOOL.colour[n])) for n in tools},
            flips_x=bool(store.read(DISPLAY.flip_x_axis)),
            flips_y=bool(store.read(DISPLAY.flip_y_axis)),
            exchanges=bool(store.read(DISPLAY.exchange_xy)),
        )

    def color(self, tool: int) -> str:
        """The colour of a path cut with a tool, on a white ground."""
        number = self.tool_colors.get(tool, tool) if self.has_tool_colors else self.path_color
        return COLORS[number % len(COLORS)].on_light

    @property
    def matrix(self) -> npt.NDArray[np.float64]:
        """Matrix from machine axes to screen axes: seen = points @ matrix.

        Flips reverse machine axes; then X and Y are exchanged.
        """
        flips = np.diag([-1.0 if self.flips_x else 1.0, -1.0 if self.flips_y else 1.0, 1.0])
        return flips[:, [1, 0, 2]] if self.exchanges else flips

    def axis_on(self, direction: int) -> tuple[int, bool]:
        """The axis of the machine along a direction of the screen, and whether it is flipped."""
        axis = (1, 0, 2)[direction] if self.exchanges else direction
        return axis, (self.flips_x, self.flips_y, False)[axis]
