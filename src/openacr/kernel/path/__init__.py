"""Coordinated moves: masters, their moves and the paths these describe."""
