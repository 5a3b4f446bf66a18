"""Causes of failed connections, with the codes that host software displays."""

import errno
import socket

from openacr.client.errors import ConnectionLostError
from openacr.errors import reason

NO_DRIVER = "17054: no driver for the USB or serial port, or no such port"
WRONG_NETWORK = "11003: wrong cable, or wrong address or mask of this host"
NO_RESPONSE = "11010: wrong cable, or wrong address of the card"
REFUSED = "10061: no card listens at this address, or another device has it"
NOT_REACHABLE = "17080: the card cannot be reached"

_UNREACHABLE = frozenset(
    (errno.EHOSTUNREACH, errno.ENETUNREACH, errno.ENETDOWN, errno.EADDRNOTAVAIL)
)


def network_cause(failure: Exception) -> str:
    """Code and usual cause of a failed network connection."""
    if isinstance(failure, ConnectionRefusedError):
        return REFUSED
    if isinstance(failure, TimeoutError):
        return NO_RESPONSE
    if isinstance(failure, socket.gaierror) or getattr(failure, "errno", None) in _UNREACHABLE:
        return WRONG_NETWORK
    return NOT_REACHABLE


def cannot_connect(name: str, failure: Exception) -> ConnectionLostError:
    """The error for a failed network connection, with its cause."""
    why = reason(failure) or "no answer"
    return ConnectionLostError(f"cannot connect to {name}: {why} ({network_cause(failure)})")
