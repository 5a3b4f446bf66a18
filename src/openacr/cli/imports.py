"""Imports of commands that run for long."""

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def imports() -> Iterator[None]:
    """Import without looking for garbage, now or in any later collection: modules stay."""
    gc.disable()
    try:
        yield
        gc.freeze()
    finally:
        gc.enable()
