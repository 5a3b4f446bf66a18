"""Messages of the Debug Adapter Protocol: JSON objects with a header that gives their length."""

from __future__ import annotations

from typing import IO, Any

import msgspec

from openacr.errors import UserError

LONGEST_BYTES = 1 << 24  # of a message that is read
_HEADER_BYTES = 1 << 12
# Any other line is refused: a web page can have a browser send `POST /a:b HTTP/1.1` to this port.
_HEADERS = (b"content-length", b"content-type")


class BrokenStreamError(UserError):
    """What the client sends cannot be separated into messages any more."""


def read_message(stream: IO[bytes]) -> dict[str, Any] | None:
    """The next message, None at the end of the stream; BrokenStreamError for anything else."""
    length = None
    while True:
        line = stream.readline(_HEADER_BYTES)
        if not line:
            return None
        if line in (b"\r\n", b"\n"):
            break
        name, colon, value = line.partition(b":")
        name = name.strip().lower()
        if not colon or not line.endswith(b"\n") or name not in _HEADERS:
            raise BrokenStreamError(f"{line[:60]!r} is not a header")
        if name == b"content-length":
            length = _length(value.strip())
    if length is None:
        raise BrokenStreamError("a message has no Content-Length")
    data = bytearray()
    while len(data) < length:
        part = stream.read(length - len(data))  # an unbuffered stream may give less
        if not part:
            return None
        data += part
    try:
        message = msgspec.json.decode(data)
    except (msgspec.MsgspecError, RecursionError) as error:
        raise BrokenStreamError(f"a message is no JSON: {error}") from None
    if not isinstance(message, dict):
        raise BrokenStreamError("a message is no JSON object")
    return message


def _length(digits: bytes) -> int:
    if not digits.isdigit() or len(digits) > 9 or int(digits) > LONGEST_BYTES:
        raise BrokenStreamError(
            f"Content-Length {digits[:20]!r}: a number of bytes, at most {LONGEST_BYTES}"
        )
    return int(digits)


def write_message(stream: IO[bytes], message: dict[str, Any]) -> None:
    """Write a message at once."""
    data = msgspec.json.encode(message)
    stream.write(b"Content-Length: %d\r\n\r\n" % len(data) + data)
    stream.flush()
