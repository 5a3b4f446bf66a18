"""Fieldbuses with real drives and terminals, and what can be in their place on a bench."""
