"""Places of rows, one module per family (`map/families.py`)."""


def every(records: int | tuple[int, ...], size: int) -> slice:
    """All places of the records of a family, which lie one after the other."""
    first, last = (records, records) if isinstance(records, int) else (records[0], records[-1])
    return slice(first, last + size)
