"""Words of the command line as texts, paths and numbers, without the package typer uses for it.

typer (0.29) imports pydantic for every parameter, also for one that is not given. That takes
longer than a short command does.
"""

import math
import os
import re
from pathlib import Path
from typing import Any

from openacr.errors import UserError
from openacr.units import quantity

# Rules of typer for a value. With any of them the conversion is left to it.
RULES = (
    "parser", "click_type", "exists", "resolve_path", "writable", "path_type", "allow_dash",
)  # fmt: skip
EXAMPLES = {"s": "90 or 10min", "mm": "200 or 5cm", "in": "8 or 5cm", "deg": "360 or 2rev",
            "rev": "40 or 720deg"}  # fmt: skip
CONVERSION = "_runtime_param"  # the attribute of a parameter that typer converts by, if it is set


_PLAIN = {int: re.compile(r"[+-]?[0-9]{1,9}"), float: re.compile(r"[+-]?[0-9]{1,9}(\.[0-9]{1,9})?")}


class Quick:
    """Conversion of the values of one parameter; what is not plain goes to typer."""

    def __init__(self, parameter: Any) -> None:
        info = parameter.type_descriptor.parameter_info
        has_rules = any(getattr(info, name, None) for name in RULES)
        is_plain = info.file_okay and info.dir_okay and not has_rules
        self._is_many = parameter.multiple or parameter.nargs != 1
        kind = parameter.type_descriptor.annotation
        self._kind: Any = kind if is_plain and not self._is_many else None
        self._least = -math.inf if info.min is None else info.min
        self._most = math.inf if info.max is None else info.max

    def coerce(self, value: Any, param: Any, ctx: Any) -> Any:
        """The value of a parameter; None, or no values, where it is not given."""
        if value is None:
            return () if self._is_many else None
        made = self._made(value)
        if made is None:
            setattr(param, CONVERSION, None)
            return param.get_runtime_param().coerce(value, param=param, ctx=ctx)
        return made

    def _made(self, value: Any) -> Any:
        """The value of a text, or of a default; None where typer has to say."""
        kind = self._kind
        if kind is str or (kind is Path and os.access(value, os.R_OK)):
            return kind(value)
        plain = _PLAIN.get(kind)
        if plain and (type(value) is kind or (isinstance(value, str) and plain.fullmatch(value))):
            made = kind(value)
            return made if self._least <= made <= self._most else None
        return None


def quick(parameters: list[Any]) -> list[Any]:
    """Parameters of a command with the quick conversion."""
    for parameter in parameters:
        if getattr(parameter, CONVERSION, "") is None:
            setattr(parameter, CONVERSION, Quick(parameter))
    return parameters


def given_quantity(option: str, text: str, unit: str) -> float:
    """The value of an option with a unit, such as `--for 10min`, in `unit`; UserError."""
    try:
        return quantity(text, unit)
    except ValueError as error:
        raise UserError(f"{option} {text}: give {error}, such as {EXAMPLES[unit]}") from None
