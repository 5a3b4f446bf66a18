"""Curves in time on a card: which machines have them, and how their knots are spaced."""

from openacr.mill.config.settings import Settings
from openacr.models import Feature

PERIOD_S = 0.004  # from one control point to the next
RANK = 4  # order of the NURBs: cubic


def can_plan(settings: Settings) -> bool:
    """Whether the machine has a jerk limit, and its card the curves a plan is sent as."""
    return settings.speeds.jerk_ups3 > 0.0 and Feature.NURBS not in settings.model.lacks
