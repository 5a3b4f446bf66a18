"""Coordinated moves: what a command or a host asks for becomes records of a ring."""
