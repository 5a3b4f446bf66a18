"""Positions of the axes of a machine, read from its card with one request."""

from collections.abc import Callable
from dataclasses import dataclass

from openacr.map.rows import axes as axis_rows
from openacr.map.rows import masters
from openacr.map.words import af1, mf1
from openacr.mill.config.settings import S_PER_MIN, Settings

ROWS = (
    axis_rows.current_position,
    axis_rows.jog_offset,
    axis_rows.actual_position,
    axis_rows.following_error,
)
Axes = tuple[float, ...]
Rows = Callable[[list[int]], list[float]]  # parameters of a card: by its link, or its memory


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
    rows = [row[a.index] for row in ROWS for a in axes]
    words = [af1.word[axis.index] for axis in axes]
    more = [mf1.word[master], masters.vector_velocity[master]]
    values = read([*rows, *words, *more])
    count = len(axes)
    columns = [
        tuple(v / axis.pulses_per_unit for v, axis in zip(part, axes, strict=True))
        for part in (values[k * count : (k + 1) * count] for k in range(len(ROWS)))
    ]
    current, jogs, actual, following = columns
    flags = [int(word) for word in values[len(rows) : len(rows) + count]]
    word, speed_ups = int(values[-2]), values[-1]
    jogged = sum(1 << place for place, flag in enumerate(flags) if flag & af1.JOG_ACTIVE)
    return Place(
        commanded=tuple(a + b for a, b in zip(current, jogs, strict=True)),
        actual=actual,
        following=following,
        jogs=jogs,
        moving=jogged,
        is_moving=bool(word & mf1.IN_MOTION) or bool(jogged),
        speed_upm=speed_ups * S_PER_MIN,
        master=word,
    )
