"""Trajectories of paths with a tolerance, limited in jerk: geometry and time law, no card, no clock."""

from openacr.trajectory.limits import Limits, TrajectoryError
from openacr.trajectory.planner import TrajectoryPlanner
from openacr.trajectory.segments import Arc, Segment
from openacr.trajectory.setpoints import Setpoints, evaluate

__all__ = [
    "Arc",
    "Limits",
    "Segment",
    "Setpoints",
    "TrajectoryError",
    "TrajectoryPlanner",
    "evaluate",
]
