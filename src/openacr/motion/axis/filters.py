"""The two digital filters of an axis' output: low-pass (LOPASS) and notch (NOTCH).

Both are second-order sections  y = a0 x + a1 x1 + a2 x2 - b1 y1 - b2 y2.  Filter 0 takes
the low-pass, filter 1 the notch, so that copying the coefficients of 0 to 1 doubles the
low-pass. Frequencies above 0.45 of the servo rate count as 0.45 of it.
"""

from __future__ import annotations

from math import cos, pi, sin, sqrt, tan
from typing import NamedTuple

from openacr.map.rows import axes
from openacr.map.words import af1
from openacr.motion.card import AXES, Card

HIGHEST_SHARE = 0.45  # of the servo rate
STATES = 2  # per filter
_FIRST_ROWS = (axes.filter0_b2, axes.filter1_b2)


class Biquad(NamedTuple):
    """Coefficients in the order of their parameters."""

    b2: float
    a2: float
    b1: float
    a1: float
    a0: float


BYPASS = Biquad(0.0, 0.0, 0.0, 0.0, 1.0)


def low_pass(cutoff_hz: float, period_s: float) -> Biquad:
    """Butterworth of second order: K = tan(pi fc T), n = 1/(1 + sqrt(2) K + K^2)."""
    if cutoff_hz <= 0.0:
        return BYPASS
    k = tan(pi * min(cutoff_hz * period_s, HIGHEST_SHARE))
    n = 1.0 / (1.0 + sqrt(2.0) * k + k * k)
    a0 = k * k * n
    return Biquad((1.0 - sqrt(2.0) * k + k * k) * n, a0, 2.0 * (k * k - 1.0) * n, 2.0 * a0, a0)


def notch(center_hz: float, width_hz: float, period_s: float) -> Biquad:
    """Zeros on the unit circle at w = 2 pi f0 T, poles as far inside as the width demands."""
    if center_hz <= 0.0 or width_hz <= 0.0:
        return BYPASS
    center_hz = min(center_hz, HIGHEST_SHARE / period_s)
    w = 2.0 * pi * center_hz * period_s
    alpha = sin(w) * width_hz / (2.0 * center_hz)
    a0 = 1.0 / (1.0 + alpha)
    a1 = -2.0 * cos(w) * a0
    return Biquad((1.0 - alpha) * a0, a0, a1, a1, a0)


def low_pass_hz(card: Card, axis: int) -> float:
    """What LOPASS was given."""
    return card.memory.F[axes.lopass_hz[axis]]


def notch_hz(card: Card, axis: int) -> tuple[float, float]:
    """Centre and width NOTCH was given."""
    return card.memory.F[axes.notch_hz[axis]], card.memory.F[axes.notch_width_hz[axis]]


def set_low_pass(card: Card, axis: int, cutoff_hz: float) -> None:
    """LOPASS: 0 is bypass."""
    card.memory.F[axes.lopass_hz[axis]] = cutoff_hz
    _put(card, axis, 0, low_pass(cutoff_hz, card.clock.period_s))
    _activate(card, axis)


def set_notch(card: Card, axis: int, center_hz: float, width_hz: float) -> None:
    """NOTCH: 0 is bypass."""
    card.memory.F[axes.notch_hz[axis]] = center_hz
    card.memory.F[axes.notch_width_hz[axis]] = width_hz
    _put(card, axis, 1, notch(center_hz, width_hz, card.clock.period_s))
    _activate(card, axis)


def change_period(card: Card, period_s: float) -> None:
    """Set the servo period and keep the frequencies of all filters.

    A filter whose coefficients were written by hand keeps those instead.
    """
    unwritten = [
        (axis, place)
        for axis in range(AXES)
        for place, designed in enumerate(_designed(card, axis))
        if _is(card, axis, place, designed)
    ]
    card.set_period(period_s)
    for axis, place in unwritten:
        _put(card, axis, place, _designed(card, axis)[place])


def _designed(card: Card, axis: int) -> tuple[Biquad, Biquad]:
    """What both filters are at the present servo period, by their frequencies."""
    period_s = card.clock.period_s
    return low_pass(low_pass_hz(card, axis), period_s), notch(*notch_hz(card, axis), period_s)


def _row(axis: int, place: int) -> int:
    return _FIRST_ROWS[place][axis]


def _put(card: Card, axis: int, place: int, filter_: Biquad) -> None:
    row = _row(axis, place)
    for offset, value in enumerate(filter_):
        card.memory.S[row + offset] = value


def _is(card: Card, axis: int, place: int, filter_: Biquad) -> bool:
    """Whether a filter has these coefficients, to the precision they are stored with."""
    row = _row(axis, place)
    stored = card.memory.S[row : row + len(filter_)]
    return all(abs(a - b) <= 1e-6 * abs(b) for a, b in zip(stored, filter_, strict=True))


def _activate(card: Card, axis: int) -> None:
    """Set Biquad Filter Activate if any filter does anything; then it starts from rest."""
    word = af1.word[axis]
    flags = card.memory.I[word]
    if all(_is(card, axis, place, BYPASS) for place in (0, 1)):
        card.memory.I[word] = flags & ~af1.BIQUAD_FILTER_ACTIVATE
        return
    if not flags & af1.BIQUAD_FILTER_ACTIVATE:
        states = axes.filter_state[axis]
        for place in range(len(_FIRST_ROWS) * STATES):
            card.memory.F[states + place] = 0.0
    card.memory.I[word] = flags | af1.BIQUAD_FILTER_ACTIVATE
