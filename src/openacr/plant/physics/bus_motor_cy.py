"""Motors of drives on a bus: they are where the drive has reported them.

What the bus brings between two ticks (`fieldbus/`) takes effect in the next one, as the signals of
an encoder do. A touch probe of the drive latches the position in the drive; the card takes it for
the edge of the first external input of a capture, or for the marker of the motor.
"""

from openacr.map import numbers as at
from openacr.views import F64, I32

OF_INPUT = 3  # edges of the input: rising, falling
MARKER_SHIFT = 2  # those of the marker follow


def bus_motor(F: F64, I: I32, n: int) -> None:
    """Bring motor n to its reported position, and the latches of its drive with it."""
    x: int = at.PLXI_BASE + n * at.PLXI_STRIDE
    F[at.PLF_BASE + n * at.PLF_STRIDE + at.PLF_POSITION_CNT] = F[
        at.PLXF_BASE + n * at.PLXF_STRIDE + at.PLXF_REPORTED_CNT
    ]
    I[x + at.PLXI_PROBE_EDGES] = I[x + at.PLXI_REPORTED_EDGES] & OF_INPUT


def reported_marker(I: I32, n: int) -> int:
    """The edges of the marker that the drive of motor n has latched since the last tick."""
    x: int = at.PLXI_BASE + n * at.PLXI_STRIDE
    edges: int = (I[x + at.PLXI_REPORTED_EDGES] >> MARKER_SHIFT) & OF_INPUT
    I[x + at.PLXI_REPORTED_EDGES] = 0
    return edges
