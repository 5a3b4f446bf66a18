"""Frames between server and browsers."""
