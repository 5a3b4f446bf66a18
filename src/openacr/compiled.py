"""Choose between the compiled core and the same sources run as plain Python.

`OPENACR_PURE=1` forces plain Python. An extension built from other sources than those
present is not used, and says so: results would silently belong to old code.
"""

import logging
import os
from collections.abc import Callable
from importlib import import_module
from typing import Any, ParamSpec, TypeVar, cast

_P = ParamSpec("_P")
_R = TypeVar("_R")
_log = logging.getLogger(__name__)


def _load() -> Any:
    if os.environ.get("OPENACR_PURE") == "1":
        return None
    try:
        compiled = import_module("openacr._compiled")
    except ImportError:
        return None
    from openacr.unity import source_hash

    if source_hash() != compiled.SOURCE_HASH:
        _log.warning("the compiled core is older than its sources; running plain Python")
        return None
    return compiled


extension = _load()
is_compiled = extension is not None


def counterpart(function: Callable[_P, _R]) -> Callable[_P, _R]:
    """The compiled form of a core function; LookupError when there is none."""
    if extension is None:
        raise LookupError("the compiled core is not available")
    return cast(Callable[_P, _R], getattr(extension, f"py_{function.__name__}"))


def pick(function: Callable[_P, _R]) -> Callable[_P, _R]:
    """The compiled form of a core function where there is one, else the function itself."""
    return counterpart(function) if is_compiled else function
