"""A whole card: memory, motion, language and streams wired together, with time in ticks."""

from openacr.controller.controller import Controller
from openacr.controller.loading import LoadError
from openacr.controller.snapshot import Snapshot

__all__ = ["Controller", "LoadError", "Snapshot"]
