"""Recognises a web browser by the first bytes of a connection.

A page of any web site can make a browser of this machine send bytes to a port of this machine: a
form, a picture, a WebSocket or a `fetch` without CORS. The text it chooses is the body of the
request, so a card that skips the lines in front of it as unknown commands would move axes. No
host of a card begins with a request line of HTTP (RFC 9112, 3) or a handshake of TLS
(RFC 8446, 5.1), so such a connection is ended before any line of it is complete.
"""

import re

TLS_HANDSHAKE = b"\x16\x03"
_CONTROL = re.compile(rb"[\x00-\x1f\x7f]")  # in a request line only at its end
_VERSION = re.compile(rb" HTTP/\d(?:\.\d)?\Z")
VERSION_BYTES = len(b" HTTP/1.1")


class Opening:
    """The first line of a connection, received in pieces of any size.

    Only its two ends are kept: the target of a request may be of any length.
    """

    def __init__(self) -> None:
        self._head = b""
        self._tail = b""
        self.is_over = False

    def is_web(self, data: bytes) -> bool:
        """Whether the connection is a browser's, as far as these bytes tell.

        Nothing up to the bytes for which this is true completes a line, a packet or a key.
        """
        if self.is_over:
            return False
        if not self._tail:
            data = data.lstrip(b"\r\n")  # a server skips empty lines in front of a request
        self._head = (self._head + data)[: len(TLS_HANDSHAKE)]
        end = _CONTROL.search(data)
        self._tail = (self._tail + data[: end.start() if end else None])[-VERSION_BYTES:]
        self.is_over = end is not None and self._head != TLS_HANDSHAKE[:1]
        return self._head == TLS_HANDSHAKE or (
            self.is_over and _VERSION.search(self._tail) is not None
        )
