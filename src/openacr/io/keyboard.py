"""Convert the keys of an operator into the bytes sent to the card.

The card echoes and edits the line itself; the keyboard side only adds the recall of earlier
lines, which the card lacks. A recalled line is typed by this program, after erasing the
current one, so that the card's own echo shows it exactly.
"""

import re
from dataclasses import dataclass, field

CR, BS, DEL, ESC, CTRL_C = 0x0D, 0x08, 0x7F, 0x1B, 0x03
UP, DOWN = (b"\x1b[A", b"\x1bOA"), (b"\x1b[B", b"\x1bOB")
# What keys without a character send: ESC [ parameters letter-or-tilde, ESC O letter.
_SEQUENCE = re.compile(rb"\x1b(?:\[[0-?]*[ -/]*[@-~]?|O[@-~]?)")
HISTORY_LINES = 500


@dataclass(slots=True)
class History:
    """Earlier lines and the one shown at present."""

    lines: list[bytes] = field(default_factory=list)
    _at: int = 0

    def __post_init__(self) -> None:
        self._at = len(self.lines)

    def add(self, line: bytes) -> None:
        """Remember a finished line; repeated and empty ones once or not at all."""
        if line.strip() and self.lines[-1:] != [line]:
            self.lines.append(line)
            del self.lines[:-HISTORY_LINES]
        self._at = len(self.lines)

    def move(self, step: int) -> bytes:
        """The next older (-1) or newer (+1) line; empty below the newest."""
        self._at = min(max(self._at + step, 0), len(self.lines))
        return self.lines[self._at] if self._at < len(self.lines) else b""


@dataclass(slots=True)
class Keyboard:
    """Follows the line being typed and turns arrow keys into recalled lines."""

    history: History = field(default_factory=History)
    leave: bool = False
    _line: bytearray = field(default_factory=bytearray)

    def feed(self, keys: bytes) -> bytes:
        """What to send for these key codes; a lone ESC must be the last of them."""
        sent = bytearray()
        at = 0
        while at < len(keys) and not self.leave:
            special = _SEQUENCE.match(keys, at)
            sent += self._arrow(special[0]) if special else self._key(keys[at])
            at = special.end() if special else at + 1
        return bytes(sent)

    def _key(self, key: int) -> bytes:
        """What to send for a key with a code of its own."""
        if key == CTRL_C:
            self.leave = True
            return b""
        self._follow(key)
        return bytes((key,))

    def _arrow(self, code: bytes) -> bytes:
        """The bytes for a key that sends a sequence: none except for up and down."""
        if code not in UP + DOWN:
            return b""
        recalled = self.history.move(-1 if code in UP else 1)
        erased = bytes((BS,)) * len(self._line)
        self._line[:] = recalled
        return erased + recalled

    def _follow(self, key: int) -> None:
        """Keep the same line as the card does."""
        if key == CR:
            self.history.add(bytes(self._line))
            self._line.clear()
        elif key == ESC:
            self._line.clear()
        elif key in (BS, DEL):
            del self._line[-1:]
        elif key >= 0x20:
            self._line.append(key)
