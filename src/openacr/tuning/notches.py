"""Gains and filters for an axis whose load is on an elastic shaft.

A loop that is faster than the resonance allows makes it swing. Tried are the filters that the
axis has, a NOTCH at the resonance, and a LOPASS, each with the gains that have the margins with
it (`openacr.tuning.propose`); a loop has to bear a resonance that is off by some per cent, too.
Of those that are nearly as fast as the fastest, the one counts whose load swings least after a
step.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

from openacr.errors import UserError
from openacr.tuning import predict
from openacr.tuning.filters import Filters
from openacr.tuning.motor import Motor
from openacr.tuning.propose import SLOWEST_HZ, Proposal, Wish, propose
from openacr.tuning.settings import LoopSettings
from openacr.tuning.shaft import Shaft

WIDTHS = (0.3, 0.6, 1.0)  # of a notch, by its centre
CUTOFFS = (0.7,)  # of a low-pass, by the resonance
OFF_SHARE = 0.05  # by which a resonance may be off
NEARLY = 0.9  # as fast
CLEARLY = 0.8  # of a swing: what is not smaller than this is no reason for a filter
STEP_CNT, STEP_S = 100, 0.25
HIGHEST_SHARE = 0.45  # of the servo rate: of a filter


@dataclass(frozen=True, slots=True)
class _Tried:
    proposal: Proposal
    vibration_cnt: float


def choose(
    present: LoopSettings, motor: Motor, wish: Wish | None = None, *, measured_to_hz: float
) -> Proposal:
    """Gains and filters for a motor; UserError where none have the margins.

    Filters that were written by hand are kept.
    """
    if motor.shaft is None or present.filters is None:
        return propose(present, motor, wish, measured_to_hz=measured_to_hz)
    others = [
        replace(motor, shaft=replace(motor.shaft, resonance_hz=motor.shaft.resonance_hz * share))
        for share in (1.0 - OFF_SHARE, 1.0 + OFF_SHARE)
    ]
    tried: list[_Tried] = []
    refusal: UserError | None = None
    for filters in _candidates(present.filters, motor.shaft, present.period_s):
        filtered = present if filters == present.filters else present.filtered(filters)
        try:
            found = propose(
                filtered,
                motor,
                wish,
                measured_to_hz=measured_to_hz,
                others=others,
                slowest_hz=max([SLOWEST_HZ, *(NEARLY * each.proposal.asked_hz for each in tried)]),
            )
        except UserError as refused:
            refusal = refusal or refused
            continue
        tried.append(_Tried(found, _vibration(found.settings, motor, motor.shaft)))
    if not tried:
        raise refusal or UserError("no filters were tried")
    return _best(tried)


def _candidates(present: Filters, shaft: Shaft, period_s: float) -> Iterator[Filters]:
    """Filters to try; those that change the least come first."""
    yield present
    if present.is_filtering:
        yield Filters()
    highest_hz = HIGHEST_SHARE / period_s
    center_hz = round(shaft.resonance_hz, 1)
    for width in WIDTHS:
        if center_hz < highest_hz:
            yield Filters(0.0, center_hz, round(width * center_hz, 1))
    for cutoff in CUTOFFS:
        if (cutoff_hz := round(cutoff * shaft.resonance_hz, 1)) < highest_hz:
            yield Filters(cutoff_hz)


def _vibration(settings: LoopSettings, motor: Motor, shaft: Shaft) -> float:
    """What the load swings after a step without feed-forward [counts]."""
    plain = settings.changed(ffvel=0.0, ffacc=0.0)
    return predict.vibration(predict.step(plain, motor, STEP_CNT, STEP_S), shaft)


def _best(tried: list[_Tried]) -> Proposal:
    """The proposal whose load swings clearly least among those that are nearly the fastest."""
    fastest_hz = max(each.proposal.asked_hz for each in tried)
    best, least = tried[0], math.inf
    for each in tried:
        if each.proposal.asked_hz < NEARLY * fastest_hz:
            continue
        if each.vibration_cnt < CLEARLY * least:
            best, least = each, each.vibration_cnt
    return best.proposal
