"""The SYSVAR store: system parameters, offsets and variables that outlive every run."""

from openacr.sysvar.homes import Home, Host, Writer, home_of
from openacr.sysvar.lookup import find, parameter
from openacr.sysvar.schema import CellKind, Parameter
from openacr.sysvar.store import AT_START, Changes, Store
from openacr.sysvar.values import SettingError

__all__ = [
    "AT_START",
    "CellKind",
    "Changes",
    "Home",
    "Host",
    "Parameter",
    "SettingError",
    "Store",
    "Writer",
    "find",
    "home_of",
    "parameter",
]
