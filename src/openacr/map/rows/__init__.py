"""Places of every row in the state, one module per family of objects (`map/families.py`)."""
