"""Packets of a uniform cubic B-spline: one NURB of a card, from rest to rest.

Every packet is one control point with its knot, a whole number, and weight 1; NURB Time Factor
is the time from one knot to the next, so the master passes the curve in mode 0 (time) at the
speed it was planned with. Of order 4 (cubic) with simple knots it is the uniform B-spline: three
equal points at its beginning and end let it begin and end there at rest, at knot 3 and at the
knot after that of the last point.

A point at whole pulses is sent as LONG, exactly; any other as IEEE32 units or as the nearest
pulses, whichever is nearer: a float has 24 bits, so from 2^23 pulses on the pulses win.
"""

from collections.abc import Iterator, Sequence

from openacr.mill.config.curves import RANK
from openacr.mill.config.settings import Settings
from openacr.protocol.move import Move
from openacr.protocol.move_codes import Code0, Code1, Code3

LEAD = 3  # equal points at rest at both ends
COUNTED = 2 * RANK - 1  # the first packet that completes a piece of the curve
WEIGHT = 1.0
NEAR_CNT = 1e-6  # rounding of a position that is meant to be whole pulses
FINEST_CNT = 1 << 23  # from here on a float is no nearer than whole pulses


class CurvePackets:
    """Encodes the control points of one curve after the other."""

    def __init__(self, settings: Settings) -> None:
        self._master = settings.master
        self._axes = [(axis.index, axis.pulses_per_unit) for axis in settings.axes]
        self._sent = 0

    def point(self, place_u: Sequence[float], ramp_ups2: float) -> Move:
        """The next control point, one value per configured axis [units of the machine].

        The first one brings the ramp along at which the card itself would hold the curve.
        """
        knot, self._sent = float(self._sent), self._sent + 1
        return Move.of(
            dict(self._targets(place_u)),
            master=self._master,
            code0=self._code0(),
            code1=int(Code1.NURB),
            code3=int(Code3.CURVE),
            acc=ramp_ups2 if self._sent == 1 else None,
            scaling=(knot, WEIGHT),
        )

    def end(self) -> Move:
        """The end of the curve, a negative knot; the next point begins another one."""
        knot = float(self._sent)
        code0 = self._code0()
        self._sent = 0
        return Move.of(
            {}, master=self._master, code0=code0, code1=int(Code1.NURB),
            code3=int(Code3.CURVE), scaling=(-knot, 0.0),
        )  # fmt: skip

    @property
    def count(self) -> int:
        """Control points of the present curve so far."""
        return self._sent

    @property
    def is_counted(self) -> bool:
        """Whether the last packet completes a piece, so that the move counter counts it."""
        return self._sent == 0 or self._sent >= COUNTED

    def _code0(self) -> int:
        """FOV is locked: the curve is planned with all overrides in it."""
        counts = Code0.COUNTER if self._sent == 0 or self._sent >= COUNTED else 0
        return int(Code0.CODE_3_PRESENT | Code0.OVERRIDE_LOCKOUT | counts)

    def _targets(self, place_u: Sequence[float]) -> Iterator[tuple[int, int | float]]:
        counts = [value * scale for value, (_, scale) in zip(place_u, self._axes, strict=True)]
        whole = [round(count) for count in counts]
        is_whole = all(
            abs(count - nearest) <= NEAR_CNT for count, nearest in zip(counts, whole, strict=True)
        )
        is_far = max(map(abs, counts)) >= FINEST_CNT
        for (axis, _), value, nearest in zip(self._axes, place_u, whole, strict=True):
            yield axis, nearest if is_whole or is_far else float(value)
