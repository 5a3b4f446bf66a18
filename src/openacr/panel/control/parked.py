"""Texts that a browser has handed over before the command that sends them to the card.

A message of the socket is short, and only the socket knows who has control.
"""

from collections import OrderedDict
from hashlib import blake2b

from openacr.errors import UserError

MOST = 8


class ParkedTexts:
    """The last texts, by marks made of them."""

    def __init__(self) -> None:
        self._texts: OrderedDict[str, str] = OrderedDict()

    def put(self, text: str) -> str:
        """Keep a text; its mark."""
        mark = blake2b(text.encode(errors="replace"), digest_size=16).hexdigest()
        self._texts[mark] = text
        self._texts.move_to_end(mark)
        while len(self._texts) > MOST:
            self._texts.popitem(last=False)
        return mark

    def text(self, mark: str) -> str:
        """The text of a mark; UserError if it is no longer kept."""
        if mark not in self._texts:
            raise UserError("the text is no longer here: send it again")
        return self._texts[mark]
