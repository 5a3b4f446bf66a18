"""Conversion between characters and the bytes of a card.

Text inside the card has one character per byte. Strings and remarks typed by a user may be
UTF-8: the card stores and sends the bytes, and only their display decodes them.

Everything a card or a file of it sends to a person's screen passes `readable`, or `Screen` where
it comes in pieces: control characters are shown, not obeyed, so that no escape sequence
changes the title, the colours or the input of a terminal.
"""

import codecs

# Quotes and dashes of the Windows code page.
_TYPOGRAPHIC = str.maketrans("\x91\x92\x93\x94\x96\x97", "''\"\"--")


# Controls a plain terminal obeys: BEL, BS, TAB, LF, CR. DEL and controls above 127 are shown.
_OBEYED = frozenset((0x07, 0x08, 0x09, 0x0A, 0x0D))
_SHOWN = {code: f"^{chr(code ^ 0x40)}" for code in (*range(0x20), 0x7F) if code not in _OBEYED}
_SHOWN |= {code: f"<{code:02X}>" for code in range(0x80, 0xA0)}


def readable(text: str) -> str:
    """Text of the card for display: decoded where it is UTF-8, else a character per byte.

    Control characters appear as `^[` or `<9B>`.
    """
    try:
        text = text.encode("latin-1").decode("utf-8")
    except UnicodeError:
        text = text.translate(_TYPOGRAPHIC)
    return text.translate(_SHOWN)


_IN_LINES = {code: f"^{chr(code ^ 0x40)}" for code in (*range(0x20), 0x7F)}
_IN_LINES |= {code: f"<{code:02X}>" for code in range(0x80, 0xA0)}
del _IN_LINES[ord("\t")], _IN_LINES[ord("\n")]


def shown(text: str) -> str:
    """Lines of a file or message as any screen or file may show them: only tabs and line ends act.

    Bytes of a file name that are no text are question marks.
    """
    return text.translate(_IN_LINES).encode("utf-8", "replace").decode()


def _as_single_byte(error: UnicodeError) -> tuple[str, int]:
    """Decode a byte that is not UTF-8 with the Windows code page."""
    if not isinstance(error, UnicodeDecodeError):
        raise error
    return chr(error.object[error.start]).translate(_TYPOGRAPHIC), error.start + 1


codecs.register_error("openacr.single-byte", _as_single_byte)


class Screen:
    """Like `readable`, for bytes that arrive in pieces of any size."""

    def __init__(self) -> None:
        self._decoder = codecs.getincrementaldecoder("utf-8")("openacr.single-byte")

    def feed(self, data: bytes) -> str:
        """What to show; the beginning of a character waits for the rest of it."""
        return self._decoder.decode(data).translate(_SHOWN)


def as_typed(text: str) -> bytes:
    """The bytes a terminal sends for text: one per character, or UTF-8 where that is not enough."""
    try:
        return text.encode("latin-1")
    except UnicodeEncodeError:
        return text.encode("utf-8")
