"""SPLINE MODE and NURB MODE: what moves are points of, and where a curve ends."""

from enum import IntEnum

from openacr.errors import CardError
from openacr.map.rows import masters
from openacr.map.words import mf3
from openacr.messages import INVALID_ARGUMENT
from openacr.motion.card import Card
from openacr.motion.path import curve_points, nurbs, splines
from openacr.motion.path.curve_points import CurvePoints


class Family(IntEnum):
    """Which curve moves are points of; the values are the flags of its mode."""

    NONE = 0
    SPLINE = mf3.SPLINE_INTERPOLATION
    NURB = mf3.NURB_INTERPOLATION


SPLINE_MODES = {0: mf3.SPLINE_TIME_MODE, 1: mf3.SPLINE_VELOCITY_MODE}
NURB_MODES = {0: mf3.NURB_TIME, 1: mf3.NURB_DYNAMIC, 4: mf3.NURB_SMOOTH}
_MODES = {Family.SPLINE: SPLINE_MODES, Family.NURB: NURB_MODES}
_NEGATIVE_KNOT = {
    Family.NONE: 0,
    Family.SPLINE: mf3.SPLINE_NEG_KNOT,
    Family.NURB: mf3.NURB_NEG_KNOT,
}
SHORTEST_S = 1e-6


def family(card: Card, master: int) -> Family:
    """What the moves of a master are points of."""
    flags = card.memory.I[mf3.word[master]]
    return next((one for one in (Family.NURB, Family.SPLINE) if flags & one), Family.NONE)


def mode(card: Card, master: int, wanted: Family) -> int | None:
    """The mode of a family, None while it is off."""
    flags = card.memory.I[mf3.word[master]]
    if not flags & wanted:
        return None
    return next((mode for mode, flag in _MODES[wanted].items() if flags & flag), 0)


def begin(card: Card, master: int, wanted: Family, number: int) -> None:
    """Let moves be points of a curve; an unfinished one has to be ended first."""
    curve = curve_points.load(card, master)
    flag = _MODES[wanted].get(number)
    if flag is None or curve.is_open:
        raise CardError(INVALID_ARGUMENT)
    if curve.points:
        curve_points.store(card, master, CurvePoints())
    flags = card.memory.I[mf3.word[master]]
    for one, modes in _MODES.items():
        flags &= ~(one | sum(modes.values()))
    card.memory.I[mf3.word[master]] = flags | wanted | flag


def end(card: Card, program: int, master: int, wanted: Family) -> None:
    """END: go to the end of the curve; later moves are moves again."""
    if family(card, master) is not wanted:
        return
    if wanted is Family.NURB:
        nurbs.finish(card, program, master)
    else:
        splines.finish(card, program, master)
        card.memory.I[mf3.word[master]] |= mf3.SPLINE_END
    flags = card.memory.I[mf3.word[master]]
    card.memory.I[mf3.word[master]] = flags & ~(wanted | sum(_MODES[wanted].values()))


def take(
    card: Card,
    program: int,
    master: int,
    values_cnt: dict[int, float],
    knot: float | None,
    weight: float | None,
) -> None:
    """Take a point with its knot and weight; a negative knot ends the curve with it.

    Alone a negative knot is the end and nothing else, whatever its size.
    """
    wanted = family(card, master)
    is_end = knot is not None and knot < 0.0
    if values_cnt or weight is not None or not is_end:
        size = None if knot is None else abs(knot)
        _point(card, program, master, values_cnt, size, weight)
    if is_end:
        card.memory.I[mf3.word[master]] |= _NEGATIVE_KNOT[wanted]
        end(card, program, master, wanted)


def _point(
    card: Card,
    program: int,
    master: int,
    values_cnt: dict[int, float],
    knot: float | None,
    weight: float | None,
) -> None:
    wanted = family(card, master)
    if wanted is Family.NURB:
        nurbs.take(card, program, master, values_cnt, knot, weight)
    elif wanted is Family.SPLINE and values_cnt and weight is None:
        splines.take(card, program, master, values_cnt, _time_s(card, master, knot))
        if knot is not None:
            card.memory.I[mf3.word[master]] |= mf3.SPLINE_KNOT_PRESENT
    else:
        raise CardError(INVALID_ARGUMENT)


def _time_s(card: Card, master: int, knot: float | None) -> float:
    """The time of the move to a point of a spline."""
    factor = card.memory.S[masters.spline_time_factor[master]]
    time_s = (1.0 if knot is None else knot) * factor
    if not SHORTEST_S <= time_s < 1.0 / SHORTEST_S:
        raise CardError(INVALID_ARGUMENT)
    return time_s
