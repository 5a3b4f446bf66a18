"""Tools of the tool table as values, in millimetres."""

from dataclasses import dataclass

from openacr.bridge.moment import Moment
from openacr.mill.config.tools import Tip, Tool


@dataclass(frozen=True, slots=True)
class CuttingTool:
    """A tool of the tool table, its sizes with their wear; None: that size is not entered."""

    number: int
    diameter_mm: float | None
    length_mm: float | None
    tip: Tip
    diameter_wear_mm: float = 0.0
    length_wear_mm: float = 0.0

    def __str__(self) -> str:
        return f"T{self.number} {self.text}"

    @property
    def sizes_mm(self) -> tuple[float | None, float | None]:
        """Diameter and length."""
        return self.diameter_mm, self.length_mm

    @property
    def wears_mm(self) -> tuple[float, float]:
        """The parts of diameter and length that are wear."""
        return self.diameter_wear_mm, self.length_wear_mm

    @property
    def text(self) -> str:
        """Its sizes in words: `diameter 6 mm, length 50.2 mm, flat`."""
        sizes = zip(("diameter", "length"), self.sizes_mm, strict=True)
        words = [f"{name} {size:.9g} mm" for name, size in sizes if size is not None]
        return ", ".join([*words, self.tip.name.lower()])

    @property
    def labels(self) -> tuple[str, str]:
        """Its number and its sizes."""
        return str(self.number), self.text


def cutting_tools(moment: Moment) -> tuple[CuttingTool, ...] | None:
    """The tools at a time; None where they are not known."""
    if moment.tools is None or moment.lost:
        return None
    return tuple(_cutting_tool(each, moment.mm_per_unit) for each in moment.tools)


def _cutting_tool(tool: Tool, mm_per_unit: float) -> CuttingTool:
    diameter_mm = None if tool.radius_u is None else 2.0 * tool.radius_u * mm_per_unit
    length_mm = None if tool.length_u is None else tool.length_u * mm_per_unit
    wears_mm = (2.0 * tool.radius_wear_u * mm_per_unit, tool.length_wear_u * mm_per_unit)
    return CuttingTool(tool.number, diameter_mm, length_mm, tool.tip, *wears_mm)
