"""Conversion between lines of text and the bytes a card sends and receives."""

import re

from openacr.errors import UserError
from openacr.lang.characters import readable

_CONTROL = re.compile(r"[\x00-\x08\x0a-\x1f\x7f]")  # keys, line ends, headers of packets
# Typographic characters of published text and the plain ones the card accepts.
_PLAIN = str.maketrans(
    "\u201c\u201d\u201e\u2018\u2019\u201a\u2013\u2014\u2212\u00a0", "\"\"\"'''--- "
)


def bytes_of(text: str) -> bytes:
    """Encode text for a card: one byte per character, quotes and dashes made plain."""
    if control := _CONTROL.search(text):
        raise UserError(f"{control[0]!r} cannot be part of a line: {text!r}")
    try:
        return text.translate(_PLAIN).encode("latin-1")
    except UnicodeEncodeError as wrong:
        raise UserError(f"{text[wrong.start]!r} cannot be sent to a card: {text}") from None


def split(text: bytes) -> tuple[str, ...]:
    """The lines of an answer; the last one may lack its end."""
    lines = readable(text.decode("latin-1")).split("\r\n")
    return tuple(lines[:-1] if not lines[-1] else lines)
