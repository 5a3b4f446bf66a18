"""Trajectories planned on the host: limited in jerk, within a tolerance of the programmed path."""

from openacr.trajectory.path.limits import Limits, TrajectoryError
from openacr.trajectory.path.segments import Arc, Segment
from openacr.trajectory.path.setpoints import Setpoints, evaluate
from openacr.trajectory.stream.planner import TrajectoryPlanner

__all__ = [
    "Arc",
    "Limits",
    "Segment",
    "Setpoints",
    "TrajectoryError",
    "TrajectoryPlanner",
    "evaluate",
]
