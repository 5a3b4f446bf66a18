"""The filters of the output of an axis as their commands give them: LOPASS and NOTCH."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from openacr.map.rows import axes
from openacr.motion.axis.filters import low_pass, notch

Row = tuple[int, ...]  # the parameter of each axis
FILTERS: tuple[tuple[Row, ...], ...] = (  # rows of the coefficients b2 a2 b1 a1 a0
    (axes.filter0_b2, axes.filter0_a2, axes.filter0_b1, axes.filter0_a1, axes.filter0_a0),
    (axes.filter1_b2, axes.filter1_a2, axes.filter1_b1, axes.filter1_a1, axes.filter1_a0),
)
SAME = 1e-5  # relative difference of coefficients that are the same in single precision


@dataclass(frozen=True, slots=True)
class Filters:
    """Frequencies of both filters [Hz]; 0 is no filter."""

    lopass_hz: float = 0.0
    notch_hz: float = 0.0
    notch_width_hz: float = 0.0

    @property
    def is_filtering(self) -> bool:
        """Whether any of them does anything."""
        return self.lopass_hz > 0.0 or (self.notch_hz > 0.0 and self.notch_width_hz > 0.0)

    def rows(self, period_s: float) -> dict[Row, float]:
        """Coefficients by row, in single precision as the card computes with them."""
        designed = (
            low_pass(self.lopass_hz, period_s),
            notch(self.notch_hz, self.notch_width_hz, period_s),
        )
        return {
            row: float(np.float32(value))
            for coefficients, filter_ in zip(FILTERS, designed, strict=True)
            for row, value in zip(coefficients, filter_, strict=True)
        }

    def lines(self, axis: int) -> list[str]:
        """Lines that set both filters of an axis."""
        return [
            f"AXIS{axis} LOPASS {self.lopass_hz:.7G}",
            f"AXIS{axis} NOTCH ({self.notch_hz:.7G},{self.notch_width_hz:.7G})",
        ]

    def are(self, rows: Sequence[float], period_s: float) -> bool:
        """Whether coefficients are those of these filters, and were not written by hand."""
        designed = list(self.rows(period_s).values())
        return bool(np.allclose(rows, designed, rtol=SAME, atol=SAME))
