"""Library parts with the sizes of an operator."""

from collections.abc import Mapping

from openacr.cnc.parts.library import Ready, part_named, prepared
from openacr.errors import UserError
from openacr.sysvar import Store
from openacr.sysvar.tabs import DISPLAY, GENERAL

METRIC = 21


def is_metric(store: Store) -> bool:
    """Whether programs begin in millimetres, as the start set and the DISPLAY page say."""
    chosen = store.read(GENERAL.start_unit) if store.read(GENERAL.start_set_chosen) else 0
    return (chosen or store.read(DISPLAY.control_mode)) == METRIC


def ready(name: str, values: Mapping[str, float], store: Store, tool: int = 0) -> Ready:
    """A part with these sizes, by cell or name; UserError where they do not fit."""
    part = part_named(name)
    given = {part.size(key).cell: value for key, value in values.items()}
    if any(value != value for value in given.values()):
        raise UserError("a size is not a number")
    return prepared(part, given, store, is_metric=is_metric(store), d_number=tool)
