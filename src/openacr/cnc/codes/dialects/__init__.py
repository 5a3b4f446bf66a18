"""The languages; importing the package registers them."""

from openacr.cnc.codes.dialects import acromill, rs274ngc

__all__ = ["acromill", "rs274ngc"]
