"""Trajectories planned on the host: limited in jerk, within a tolerance of the programmed path."""
