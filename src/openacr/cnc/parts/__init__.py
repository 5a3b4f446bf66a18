"""The library of parts: programs with sizes to choose."""
