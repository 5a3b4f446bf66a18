"""Threads that execute programs and typed lines, and the language side of a card as a whole."""
