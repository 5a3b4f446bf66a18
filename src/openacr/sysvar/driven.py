"""Whether a program drives the machine of a store now, whatever its cells were left at."""

from pathlib import Path

from openacr.locks import is_taken

SUFFIX = "-machine"


def machine_lock(store: Path) -> Path:
    """The file that a program locks as long as it drives the machine of a store."""
    return store.with_name(store.name + SUFFIX)


def is_driven(store: Path | None) -> bool:
    """Whether a program holds that lock; a store without a file has no other programs."""
    return store is None or is_taken(machine_lock(store))
