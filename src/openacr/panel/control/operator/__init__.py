"""Operators: who has control, what moves by hand, what is typed, the part program."""
