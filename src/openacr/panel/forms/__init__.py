"""Forms as data: rows of the tables of the store, with values, units, limits and help."""
