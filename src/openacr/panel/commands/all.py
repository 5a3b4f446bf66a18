"""Imports every module of commands: the table is complete then."""

from openacr.panel.commands import (  # noqa: F401
    bus,
    debugging,
    drives,
    memory,
    motion,
    people,
    programs,
    recording,
    running,
    service,
    timeline,
    tuning,
    typing,
    watching,
    world,
)
from openacr.panel.commands.registry import COMMANDS as COMMANDS
from openacr.panel.commands.registry import carry_out as carry_out
