"""Courses: a path with a time law, evaluated at any time."""
