"""The requests of the protocol, a function for each; importing this package fills the table."""

from openacr.debugger.answers import breakpoints, history, launch, running, values

__all__ = ["breakpoints", "history", "launch", "running", "values"]
