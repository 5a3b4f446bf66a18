"""Paths: segments, the limits along them, and the tube that smooths them."""
