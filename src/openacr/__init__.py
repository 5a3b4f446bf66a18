"""A software ACR motion controller: AcroBASIC on a virtual card with real servo dynamics.

`openacr.Controller.from_project("examples/gantry")` is where to begin.
"""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from openacr.controller import Controller, LoadError, Snapshot

__all__ = ["Controller", "LoadError", "Snapshot"]


def __getattr__(name: str) -> Any:
    """Load the public names at first use: `openacr --help` needs none of them."""
    if name not in __all__:
        raise AttributeError(f"module 'openacr' has no attribute {name!r}")
    from openacr import controller

    return getattr(controller, name)
