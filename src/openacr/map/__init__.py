"""The card's memory: what every parameter and flag number means and where it is kept."""

from openacr.map.lookup import (
    Flag,
    Parameter,
    find_flag,
    find_parameter,
    flag,
    flag_names,
    flags,
    flags_of,
    packet_groups,
    parameter,
    parameter_names,
    parameters,
)

__all__ = [
    "Flag",
    "Parameter",
    "find_flag",
    "find_parameter",
    "flag",
    "flag_names",
    "flags",
    "flags_of",
    "packet_groups",
    "parameter",
    "parameter_names",
    "parameters",
]
