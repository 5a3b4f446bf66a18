"""The keys of a Windows console for `openacr term`: read one by one, without an echo.

A console of Windows cannot be waited for together with a socket, so keys are polled between two
reads of the card.
"""

import importlib
import sys
from typing import TYPE_CHECKING, Protocol

from openacr.lang.characters import Screen

if TYPE_CHECKING:
    from openacr.client.links import Link
    from openacr.io.keyboard import Keyboard

POLL_S = 0.02
ESC = b"\x1b"
# A key without a character arrives as one of these and a letter.
PREFIXES = ("\x00", "\xe0")
SEQUENCES = {"H": b"\x1b[A", "P": b"\x1b[B"}  # arrow up, arrow down


class Console(Protocol):
    """What is used of the module `msvcrt`."""

    def kbhit(self) -> bool:
        """Whether a key waits."""

    def getwch(self) -> str:
        """The next key; nothing is shown."""


def exchange(link: "Link", keyboard: "Keyboard") -> None:
    """Keys to the card, its output to the screen, until Ctrl-C."""
    console: Console = importlib.import_module("msvcrt")
    screen = Screen()
    link.write(ESC + b"\r")  # drops what may be typed already, and asks for a prompt
    while not keyboard.leave:
        if data := link.read(POLL_S):
            sys.stdout.write(screen.feed(data))
            sys.stdout.flush()
        if keys := waiting_keys(console):
            link.write(keyboard.feed(keys))


def waiting_keys(console: Console) -> bytes:
    """The codes of the keys that wait, as a terminal sends them."""
    codes = b""
    while console.kbhit():
        key = console.getwch()
        if key in PREFIXES:
            codes += SEQUENCES.get(console.getwch(), b"")
        else:
            codes += key.encode("latin-1", "ignore")
        if codes.endswith(ESC):
            break  # a lone ESC has to be the last of the keys that are handed on
    return codes
