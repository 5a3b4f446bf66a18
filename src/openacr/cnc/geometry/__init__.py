"""Arcs, coordinate systems and the moves a program makes from where it is."""
