"""The command line of openacr: thin wrappers of the layers below."""

import gc

MANY_OBJECTS = 250_000

gc.set_threshold(MANY_OBJECTS, 20, 20)  # what is imported stays: nothing to collect yet
