"""Library parts with the sizes of an operator."""

from collections.abc import Mapping

from openacr.cnc.parts.library import Ready, begins_metric, part_named, prepared
from openacr.errors import UserError
from openacr.sysvar import Store


def ready(name: str, values: Mapping[str, float], store: Store, tool: int = 0) -> Ready:
    """A part with these sizes, by cell or name; UserError where they do not fit."""
    part = part_named(name)
    given = {part.size(key).cell: value for key, value in values.items()}
    if any(value != value for value in given.values()):
        raise UserError("a size is not a number")
    return prepared(part, given, store, is_metric=begins_metric(store), d_number=tool)
