"""Positions of the axes of a machine, read from its card with one request."""

from dataclasses import dataclass

from openacr.map import numbers as n
from openacr.map.rows import masters
from openacr.mill.config.settings import S_PER_MIN, Settings
from openacr.panel.control.rows import Rows

ROWS = (n.AX_CURRENT_POSITION, n.AX_JOG_OFFSET, n.AX_ACTUAL_POSITION, n.AX_FOLLOWING_ERROR)
Axes = tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Place:
    """Positions of the configured axes, in their order; machine coordinates, default units."""

    commanded: Axes
    actual: Axes
    following: Axes
    jogs: Axes  # offsets of jogs, part of `commanded`
    moving: int  # axes that are jogged, a bit for each in their order
    is_moving: bool
    speed_upm: float  # along the path
    master: int  # flag word


def read_place(settings: Settings, read: Rows) -> Place:
    """Read where the machine is; a link error where the card does not answer."""
    axes, master = settings.axes, settings.master
    rows = [n.AX_BASE + a.index * n.AX_STRIDE + row for row in ROWS for a in axes]
    words = [n.AF1_WORD + axis.index for axis in axes]
    more = [n.MF1_WORD + master, masters.vector_velocity[master]]
    values = read([*rows, *words, *more])
    count = len(axes)
    columns = [
        tuple(v / axis.pulses_per_unit for v, axis in zip(part, axes, strict=True))
        for part in (values[k * count : (k + 1) * count] for k in range(len(ROWS)))
    ]
    current, jogs, actual, following = columns
    flags = [int(word) for word in values[len(rows) : len(rows) + count]]
    word, speed_ups = int(values[-2]), values[-1]
    jogged = sum(1 << place for place, flag in enumerate(flags) if flag & n.AF1_JOG_ACTIVE)
    return Place(
        commanded=tuple(a + b for a, b in zip(current, jogs, strict=True)),
        actual=actual,
        following=following,
        jogs=jogs,
        moving=jogged,
        is_moving=bool(word & n.MF1_IN_MOTION) or bool(jogged),
        speed_upm=speed_ups * S_PER_MIN,
        master=word,
    )
