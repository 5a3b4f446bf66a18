"""A machine description written into the memory of a card."""
