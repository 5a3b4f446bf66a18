"""The calls of `/api`, by theme; importing this package fills the table."""

from openacr.panel.server.calls import session

__all__ = ["session"]
