"""Moves as the card executes them one by one: geometry, limits, and the speed law of the queue."""
