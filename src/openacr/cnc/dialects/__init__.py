"""The languages; importing the package registers them."""

from openacr.cnc.dialects import acromill

__all__ = ["acromill"]
