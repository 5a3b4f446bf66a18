"""Devices of a machine that are Python classes: the interface, the library, those of a project."""
