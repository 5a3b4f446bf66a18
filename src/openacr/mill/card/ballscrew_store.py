"""The ballscrew table of an axis in the store: a file beside it, its name, and whether it is on."""

import os
from pathlib import Path

from openacr.errors import UserError
from openacr.mill.card.ballscrew import Table, read
from openacr.sysvar import Store
from openacr.sysvar.tabs import OFFSETS
from openacr.wording import counted


def folder_of(store: Store) -> Path:
    """Beside the store; the folder one stands in for a store that is not made yet."""
    return store.path.parent if store.path else Path()


def kept(store: Store, axis: int, name: str) -> Table | None:
    """The table of an axis; None where the store names no file."""
    file = store.read_text(OFFSETS.ballscrew_file[axis])
    return read(folder_of(store) / file, name) if file else None


def keep(store: Store, axis: int, table: Table, *, is_on: bool) -> Path:
    """Keep a table beside the store and switch it: both or nothing."""
    place = folder_of(store) / f"ballscrew_{table.letter}.txt"
    new = place.with_name(f"{place.name}.new")
    try:
        with store.transaction():
            store.write_text(OFFSETS.ballscrew_file[axis], place.name)
            store.write(OFFSETS.ballscrew_on[axis], int(is_on))
            new.write_text(table.text(), encoding="utf-8", newline="\n")
            os.replace(new, place)
    except OSError as error:
        raise UserError(f"{place}: cannot be written: {(error.strerror or '').lower()}") from None
    finally:
        new.unlink(missing_ok=True)
    return place


def summary(table: Table) -> str:
    """Positions and the largest error of a table."""
    first, last = table.entries[0][0], table.entries[-1][0]
    positions = counted(len(table.entries), "position")
    largest = max(abs(error) for _, error in table.entries)
    return f"{positions} from {first:g} to {last:g}, largest error {largest:g}"
