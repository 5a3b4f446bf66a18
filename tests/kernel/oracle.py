"""Closed forms of the motion profiles, written from the manual and nothing else.

Speeds in units/s, distances in units, times in seconds. A rate of 0 is a velocity step.
"""

import math
from dataclasses import dataclass

from scipy.optimize import brentq


@dataclass(frozen=True)
class Leg:
    """Time, end speed and highest speed of a move, and whether its braking was forced."""

    time: float
    end: float
    peak: float
    forced: bool = False


def ramp(v1: float, v2: float, rate: float, jerk: float = 0.0) -> tuple[float, float]:
    """Time and distance of a ramp between two speeds, acceleration 0 at both ends."""
    change = abs(v2 - v1)
    if rate <= 0 or change == 0:
        return 0.0, 0.0
    if jerk <= 0:
        time = change / rate
    elif change >= rate * rate / jerk:
        time = change / rate + rate / jerk
    else:
        time = 2 * math.sqrt(change / jerk)
    return time, (v1 + v2) / 2 * time


def move(
    length: float,
    vel: float,
    acc: float,
    dec: float,
    stp: float,
    *,
    entry: float = 0.0,
    fvel: float = 0.0,
    jerk: float = 0.0,
) -> Leg:
    """A move entered at `entry` with acceleration 0; with STP 0 and jerk only if VEL is reached."""

    def distance(peak: float) -> float:
        first = ramp(entry, peak, acc if peak >= entry else dec, jerk)[1]
        return first + ramp(peak, ends(peak), stp, jerk)[1]

    def ends(peak: float) -> float:
        return peak if stp <= 0 else min(fvel, peak)

    def legs(peak: float) -> Leg:
        first = ramp(entry, peak, acc if peak >= entry else dec, jerk)
        last = ramp(peak, ends(peak), stp, jerk)
        cruise = (length - first[1] - last[1]) / peak if peak else 0.0
        return Leg(first[0] + last[0] + cruise, ends(peak), max(peak, entry))

    if distance(vel) <= length:
        return legs(vel)
    if stp <= 0 or vel <= fvel:
        rate = acc if vel >= entry else -dec
        end = math.sqrt(entry * entry + 2 * rate * length)
        return Leg((end - entry) / rate, end, max(entry, end))
    if vel >= entry and distance(max(entry, min(fvel, vel))) > length and entry <= fvel:
        end = math.sqrt(entry * entry + 2 * acc * length)  # not even FVEL
        return Leg((end - entry) / acc, end, end)
    low, high = (entry, vel) if vel >= entry else (min(fvel, entry), entry)
    near, far = distance(low) - length, distance(high) - length
    if near * far <= 0 and near != far:
        return legs(brentq(lambda p: distance(p) - length, low, high, xtol=1e-15 * vel))
    rate = (entry * entry - fvel * fvel) / (2 * length)
    return Leg((entry - fvel) / rate, fvel, entry, forced=True)
