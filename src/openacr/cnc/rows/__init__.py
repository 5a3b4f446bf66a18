"""The memory of an interpreter, and the rows in it by their names."""
