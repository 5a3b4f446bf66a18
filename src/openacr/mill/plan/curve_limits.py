"""Limits of planned paths: those of every axis, and how much of them a plan uses.

Rotary axes have theirs in degrees: the ramps and the jerk of the machine are numbers of the unit
of each axis, as they are of a move of rotary axes alone.
"""

import math

from openacr.mill.config.settings import Settings

# What is left of the limits of the machine for the changes of an override and a feed hold.
ACCELERATION_SHARE, JERK_SHARE = 0.99, 0.96
UNLIMITED = 1e6  # units/s


def stop_s(speed_ups: float, acceleration_ups2: float, jerk_ups3: float) -> float:
    """The quickest ramp from a speed to rest, v/A + A/J, or 2 sqrt(v/J) where A is not reached."""
    ramp_s = acceleration_ups2 / jerk_ups3
    if speed_ups < acceleration_ups2 * ramp_s:
        return 2.0 * math.sqrt(speed_ups / jerk_ups3)
    return speed_ups / acceleration_ups2 + ramp_s


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
