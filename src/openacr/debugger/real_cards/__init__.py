"""Debugging the programs of a card over its terminal."""
