"""Planned paths: moves that become one curve of control points."""
