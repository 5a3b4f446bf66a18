"""Sockets that listen, and why a port cannot be had."""

import errno
import socket

from openacr.errors import UserError, reason

BACKLOG = 16  # connections that wait to be accepted


def bound_socket(
    host: str, port: int, kind: socket.SocketKind, option: str, *, takes_zero: bool = True
) -> socket.socket:
    """A socket bound to the first address of `host` (port 0: any free one); one of TCP listens.

    UserError says why it cannot be had; `option` is where the user chooses the port, and
    `takes_zero` whether it takes 0 for any.
    """
    if not 0 <= port <= 0xFFFF:
        raise UserError(f"port {port} is not in 0..65535")
    try:
        found = socket.getaddrinfo(host, port, type=kind, flags=socket.AI_PASSIVE)
        family, *_, address = found[0]
        if kind is socket.SOCK_STREAM:
            return socket.create_server((str(address[0]), port), family=family, backlog=BACKLOG)
        sock = socket.socket(family, kind)
        try:
            sock.bind(address)
        except OSError:
            sock.close()
            raise
        return sock
    except OSError as failure:
        raise listen_failure(host, port, failure, option, takes_zero=takes_zero) from None


def listen_failure(
    host: str, port: int, failure: OSError, option: str, *, takes_zero: bool = True
) -> UserError:
    """The reason why listening failed, with a hint; whether the option takes 0 for any port."""
    if failure.errno == errno.EADDRINUSE:
        return UserError(
            f"port {port} on {host} is in use (is it running already?); choose another"
            f" one with {option}{', 0 picks a free one' if takes_zero else ''}"
        )
    if failure.errno == errno.EACCES:
        return UserError(f"port {port} needs special rights; choose one above 1023 with {option}")
    return UserError(f"cannot listen on {host}:{port}: {reason(failure).lower()}")
