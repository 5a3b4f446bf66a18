"""Limits of planned paths: how much of the limits of a machine a plan uses."""

from openacr.mill.config.settings import Settings
from openacr.trajectory import Limits

# What is left of the limits of the machine for the changes of an override and a feed hold.
ACCELERATION_SHARE, JERK_SHARE = 0.99, 0.96
UNLIMITED = 1e6  # units/s


def accelerations(settings: Settings) -> list[float]:
    """The acceleration limit of each configured axis [units/s2]."""
    speeds = settings.speeds
    path = [each for each in (speeds.feed_acc_ups2, speeds.rapid_acc_ups2) if each > 0.0]
    return [
        min([*path, *([own] if (own := axis.max_acceleration_ups2) > 0.0 else [])])
        for axis in settings.axes
    ]


def limits_of(settings: Settings) -> Limits:
    """What the planner may use of the limits of the machine."""
    return Limits(
        tuple(axis.max_speed_ups or UNLIMITED for axis in settings.axes),
        tuple(ACCELERATION_SHARE * each for each in accelerations(settings)),
        (JERK_SHARE * settings.speeds.jerk_ups3,) * len(settings.axes),
    )
