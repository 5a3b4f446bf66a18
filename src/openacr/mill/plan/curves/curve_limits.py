"""Limits of planned paths: those of every axis, and how much of them a plan uses.

Rotary axes have theirs in degrees: the ramps and the jerk of the machine are numbers of the unit
of each axis, as they are of a move of rotary axes alone.
"""

import math

from openacr.mill.config.curves import PERIOD_S
from openacr.mill.config.settings import Settings

# What is left of the limits of the machine for the changes of an override and a feed hold.
ACCELERATION_SHARE, JERK_SHARE = 0.99, 0.96
UNLIMITED = 1e6  # units/s
RAMPS = 2.4  # quickest ramps that are set aside for a hold of the card: measured, decision 119
NOTICED_S = 0.07  # the cycle of the watchdog, and that in which the card serves a hold
ON_THE_LINE = 25  # pieces that the host may be late by: 0.1 s
SPARE = 2  # places of the move buffer that stay free


def stop_s(speed_ups: float, acceleration_ups2: float, jerk_ups3: float) -> float:
    """The quickest ramp from a speed to rest, v/A + A/J, or 2 sqrt(v/J) where A is not reached."""
    ramp_s = acceleration_ups2 / jerk_ups3
    if speed_ups < acceleration_ups2 * ramp_s:
        return 2.0 * math.sqrt(speed_ups / jerk_ups3)
    return speed_ups / acceleration_ups2 + ramp_s


def pieces_to_rest(speed_ups: float, acceleration_ups2: float, jerk_ups3: float) -> int:
    """Pieces of a curve that a card needs to come to rest from a speed without its host."""
    rest_s = RAMPS * stop_s(speed_ups, acceleration_ups2, jerk_ups3)
    return math.ceil((rest_s + NOTICED_S) / PERIOD_S)


def moves_needed(settings: Settings) -> int:
    """The moves for which a card over a link needs room, for curves at the highest speed."""
    fastest_ups = max(min(each, settings.speeds.max_ups) for each in speeds(settings))
    rest = pieces_to_rest(fastest_ups, min(accelerations(settings)), settings.lowest_jerk_ups3)
    return rest + ON_THE_LINE + SPARE


def accelerations(settings: Settings) -> list[float]:
    """The acceleration limit of each configured axis [units/s2]."""
    ramps = settings.speeds.feed_acc_ups2, settings.speeds.rapid_acc_ups2
    path = [each for each in ramps if each > 0.0]
    return [
        min([*path, *([own] if (own := axis.max_acceleration_ups2) > 0.0 else [])])
        for axis in settings.axes
    ]


def speeds(settings: Settings) -> list[float]:
    """The speed limit of each configured axis [units/s]."""
    rotary = settings.speeds.rotary_max
    return [
        min(axis.max_speed_ups or UNLIMITED, UNLIMITED if axis.is_linear else rotary or UNLIMITED)
        for axis in settings.axes
    ]
