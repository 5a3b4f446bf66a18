"""Whether a program drives the machine of a store now, asked of its lock, not of its cells."""

from pathlib import Path

from openacr.locks import is_taken

SUFFIX = "-machine"


def machine_lock(store: Path) -> Path:
    """The file that a program keeps locked while it drives the machine of a store."""
    return store.with_name(store.name + SUFFIX)


def is_driven(store: Path | None) -> bool:
    """Whether a program holds that lock; never for a store without a file."""
    return store is None or is_taken(machine_lock(store))
