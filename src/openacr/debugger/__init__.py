"""A debugger of the programs of a virtual card, forwards and backwards."""
