"""Imports every module of commands: the table is complete then."""

from openacr.panel.commands import (
    memory,
    motion,
    people,
    programs,
    running,
    service,
    timeline,
    tuning,
    typing,
    watching,
    world,
)  # fmt: skip
from openacr.panel.commands.registry import COMMANDS, carry_out

__all__ = [
    "COMMANDS", "carry_out", "memory", "motion", "people", "programs", "running", "service",
    "timeline", "tuning", "typing", "watching", "world",
]  # fmt: skip
