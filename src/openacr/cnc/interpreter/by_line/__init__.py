"""Blocks executed many at a time from the text, on arrays."""
