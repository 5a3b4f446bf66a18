"""Flag words and masks, one module per kind of word (`map/families.py`)."""
