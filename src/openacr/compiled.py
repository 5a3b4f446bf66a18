"""Choose between the compiled core and the same sources run as plain Python.

`OPENACR_PURE=1` forces plain Python. An extension built from other sources than those
present is not used, and says so: results would silently belong to old code.
"""

import os
from collections.abc import Callable
from importlib import import_module
from typing import Any, ParamSpec, TypeVar, cast

_P = ParamSpec("_P")
_R = TypeVar("_R")
_PACKAGE = os.path.dirname(__file__)


def _load() -> Any:
    if os.environ.get("OPENACR_PURE") == "1":
        return None
    try:
        compiled = import_module("openacr._compiled")
    except ImportError:
        return None
    if looks_unchanged(compiled, _PACKAGE):
        return compiled
    from openacr.unity import source_hash

    if source_hash() == compiled.SOURCE_HASH:
        return compiled
    import logging

    logging.getLogger(__name__).warning(
        "the compiled core is older than its sources; running plain Python"
    )
    return None


def looks_unchanged(compiled: Any, package: str) -> bool:
    """Whether every source has the size it was compiled with, and none is newer than the extension.

    Of a package that is installed (no setup.py, with which it could be built) sizes count alone:
    there an installer writes all files, in any order.
    """
    can_be_built = os.path.exists(os.path.join(package, "..", "..", "setup.py"))
    try:
        built_ns = os.stat(compiled.__file__).st_mtime_ns
        for name, size in compiled.SOURCE_SIZES:
            found = os.stat(os.path.join(package, name))
            if found.st_size != size or (can_be_built and found.st_mtime_ns > built_ns):
                return False
    except OSError:
        return False
    return True


extension = _load()
is_compiled = extension is not None


def counterpart(function: Callable[_P, _R]) -> Callable[_P, _R]:
    """The compiled form of a core function; LookupError when there is none."""
    if extension is None:
        raise LookupError("the compiled core is not available")
    found = getattr(extension, f"py_{function.__name__}", None)
    if found is None:  # in a source file that was not there yet
        raise LookupError(f"{function.__name__} is not compiled yet: setup.py build_ext --inplace")
    return cast(Callable[_P, _R], found)


def pick(function: Callable[_P, _R]) -> Callable[_P, _R]:
    """The compiled form of a core function where there is one, else the function itself."""
    return counterpart(function) if is_compiled else function
