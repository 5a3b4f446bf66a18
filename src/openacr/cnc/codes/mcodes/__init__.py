"""M codes, one file per family; importing the package registers them."""

from openacr.cnc.codes.mcodes import (
    custom,
    cycle_steps,
    outputs,
    spindle,
    stops,
    tangent,
    tool,
    waits,
)

__all__ = [
    "custom", "cycle_steps", "outputs", "spindle", "stops", "tangent", "tool", "waits",
]  # fmt: skip
