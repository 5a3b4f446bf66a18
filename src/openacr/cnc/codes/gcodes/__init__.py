"""G codes, one file per family; importing the package registers them."""

from openacr.cnc.codes.gcodes import (
    compensation,
    cycles,
    dwell,
    macros,
    motion,
    offsets,
    planes_units,
    probe,
    reference,
    scaling,
    work,
)

__all__ = [
    "compensation",
    "cycles",
    "dwell",
    "macros",
    "motion",
    "offsets",
    "planes_units",
    "probe",
    "reference",
    "scaling",
    "work",
]
