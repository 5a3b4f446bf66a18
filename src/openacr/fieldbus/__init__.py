"""Buses with real devices: drives and terminals in the place of modelled ones."""
