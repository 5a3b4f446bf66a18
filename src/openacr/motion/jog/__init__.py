"""Jogs and homing of an axis."""
