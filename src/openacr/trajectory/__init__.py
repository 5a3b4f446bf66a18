"""Trajectories planned on the host: limited in jerk, within a tolerance of the programmed path."""

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
