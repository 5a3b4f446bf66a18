"""Characters and the bytes a card has for them.

Text inside the card has one character per byte. What a person writes in strings and remarks
may be UTF-8: the card keeps and sends the bytes, and only who shows them needs to know.
"""

# Quotes and dashes of the Windows code page.
_TYPOGRAPHIC = str.maketrans("\x91\x92\x93\x94\x96\x97", "''\"\"--")


def readable(text: str) -> str:
    """Text of the card as a person reads it: UTF-8 where it is, else a character per byte."""
    try:
        return text.encode("latin-1").decode("utf-8")
    except UnicodeError:
        return text.translate(_TYPOGRAPHIC)


def as_typed(text: str) -> bytes:
    """The bytes a terminal sends for text: one per character, or UTF-8 where that is not enough."""
    try:
        return text.encode("latin-1")
    except UnicodeEncodeError:
        return text.encode("utf-8")
