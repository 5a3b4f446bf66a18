"""Execution of part programs on a card: the life cycle of a run, from its start to rest."""
