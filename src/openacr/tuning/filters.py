"""The filters of the output of an axis as their commands give them: LOPASS and NOTCH."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from openacr.map import numbers as at
from openacr.motion.axis.filters import low_pass, notch

FILTERS = (at.AX_FILTER0_B2, at.AX_FILTER1_B2)  # first of five coefficients: b2 a2 b1 a1 a0
COEFFICIENTS = 5
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

    def rows(self, period_s: float) -> dict[int, float]:
        """Coefficients by row, in single precision as the card computes with them."""
        designed = (
            low_pass(self.lopass_hz, period_s),
            notch(self.notch_hz, self.notch_width_hz, period_s),
        )
        return {
            first + place: float(np.float32(value))
            for first, filter_ in zip(FILTERS, designed, strict=True)
            for place, value in enumerate(filter_)
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
