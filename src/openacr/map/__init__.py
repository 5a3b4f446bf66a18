"""The card's memory: what every parameter and flag number means and where it is kept."""

from openacr.map.lookup import (
    Flag,
    Parameter,
    find_flag,
    find_parameter,
    flag,
    flags,
    flags_of,
    packet_groups,
    parameter,
    parameters,
)

__all__ = [
    "Flag",
    "Parameter",
    "find_flag",
    "find_parameter",
    "flag",
    "flags",
    "flags_of",
    "packet_groups",
    "parameter",
    "parameters",
]
