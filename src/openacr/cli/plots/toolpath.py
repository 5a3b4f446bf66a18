"""The tool path of a part program as a picture: what is shown, and how it looks."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from openacr.mill.config.view import View
from openacr.mill.plan.pictures.tool_path import Drawing, Kind

if TYPE_CHECKING:
    from openacr.mill.plan.pictures.path_motion import Motion

COMPENSATED = (5.0, 2.0)  # dash and gap
RAPID, INSERTED, CONTOUR = "#999999", "#D5007F", "#444444"
DENSE_CNT = 5000  # from this number of moves on they are drawn thin, shaded by their height
BANDS = 16


@dataclass(frozen=True, slots=True)
class Scene:
    """A drawing with its names; `low` and `high` are the extents of the program."""

    drawing: Drawing
    title: str
    names: tuple[str, ...]
    unit: str
    low: tuple[float, ...]
    high: tuple[float, ...]
    view: View = field(default_factory=View)
    digits: tuple[int, ...] = (4, 4, 4)  # decimals, by axis
    has_errors: bool = False
    is_cut: bool = False  # there are more moves than a picture holds
    motion: "Motion | None" = None  # what the path is coloured by, in place of kinds and tools

    @property
    def point_cnt(self) -> int:
        """How many points are drawn."""
        return len(self.drawing.kinds if self.motion is None else self.motion.values)

    @property
    def has_contours(self) -> bool:
        """Whether programmed contours are shown beside compensated paths."""
        return bool(self.drawing.contours)


@dataclass(frozen=True, slots=True)
class LineStyle:
    """How moves of one kind and tool are drawn: dashes are lengths of dash and gap."""

    label: str
    color: str
    width: float
    dashes: tuple[float, ...] = ()


def style_of(kind: Kind, tool: int, view: View) -> LineStyle:
    """Rapids are grey and dotted, compensated and inserted moves dashed; the view has colours."""
    if kind is Kind.RAPID:
        return LineStyle("rapid", RAPID, 0.8, (1.5, 2.5))
    if kind is Kind.INSERTED:
        return LineStyle("inserted at corners", INSERTED, 1.7, COMPENSATED)
    color = view.color(tool)
    name = f" T{tool}" if tool else ""
    if kind is Kind.COMPENSATED:
        return LineStyle(f"compensated{name}", color, 1.3, COMPENSATED)
    return LineStyle(f"feed{name}", color, 1.2)


def bands_of(drawing: Drawing) -> int:
    """How many shades of height a drawing needs to be readable."""
    return BANDS if len(drawing.kinds) > DENSE_CNT and drawing.low[2] < drawing.high[2] else 1


def shade(color: str, band: int, bands: int) -> str:
    """A colour made darker in the depth, lighter in the height."""
    if bands == 1:
        return color
    share = 2.0 * band / (bands - 1) - 1.0
    to = 255.0 if share > 0.0 else 0.0
    parts = [int(color[k : k + 2], 16) for k in (1, 3, 5)]
    mixed = [round(part + 0.65 * abs(share) * (to - part)) for part in parts]
    return "#" + "".join(f"{part:02x}" for part in mixed)
