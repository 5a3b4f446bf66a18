"""`openacr term`: the terminal of a card, virtual or real.

The card echoes and edits lines itself, so keys are passed through byte by byte in the
terminal's raw mode. A line-editing library would show a second, invented echo; only the
recall of earlier lines is added here (`io.keyboard`).
"""

import os
import select
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from openacr.cli.live.online import BAUD, FAILED, Baud, Target
from openacr.lang.characters import Screen

if TYPE_CHECKING:
    from openacr.client.links import Wire
    from openacr.io.keyboard import History, Keyboard

ESC = b"\x1b"
ESC_WAIT_S = 0.03  # the rest of an arrow key arrives within this time
KEY_BYTES = 1024


def term(
    target: Target,
    baud: Baud = BAUD,
    wait: Annotated[
        float, typer.Option(min=0.0, help="Longest wait [s] for the prompt of a piped line.")
    ] = 60.0,
) -> None:
    """Open a terminal to a card: interactive, or line by line from piped standard input.

    Arrow up and down recall earlier lines, Ctrl-X, Ctrl-Y, Ctrl-Z and ESC go to the card,
    Ctrl-C leaves.
    """
    from openacr.client.errors import ConnectionLostError
    from openacr.client.links import wire_to

    link = wire_to(target, baud)
    link.open()
    try:
        if sys.stdin.isatty() and sys.stdout.isatty():
            _interactive(link)
        else:
            _piped(link, wait)
    except ConnectionLostError as ended:
        typer.echo(f"connection ended: {ended}", err=True)
        raise typer.Exit(FAILED) from None
    finally:
        link.close()


def _piped(link: "Wire", wait_s: float) -> None:
    """Send the lines of standard input one by one and print what comes back."""
    from openacr.client.script import Script

    def show(data: bytes) -> None:
        """Show what the card sent, with the line ends of this system's text."""
        sys.stdout.buffer.write(screen.feed(data).replace("\r", "").encode())
        sys.stdout.buffer.flush()

    screen = Screen()
    lines = (line.rstrip(b"\r\n") for line in sys.stdin.buffer)
    Script(link, show, wait_s).run(lines)


def _interactive(link: "Wire") -> None:
    """Pass keys to the card and its output to the screen until Ctrl-C."""
    from openacr.io.keyboard import Keyboard

    keyboard = Keyboard(_load_history())
    typer.echo(f"connected to {link.name}; Ctrl-C leaves", err=True)
    try:
        if find_spec("termios") is None:
            from openacr.cli.live.console import exchange

            exchange(link, keyboard)
        else:
            with _raw_terminal():
                _exchange(link, keyboard)
    finally:
        _save_history(keyboard.history.lines)
        typer.echo("", err=True)


def _exchange(link: "Wire", keyboard: "Keyboard") -> None:
    """Keys to the card, its output to the screen; the card sends its prompt first.

    A card sends no greeting: ESC drops what may be typed already, an empty line shows the prompt.
    """
    link.write(ESC + b"\r")
    stdin, stdout, screen = sys.stdin.fileno(), sys.stdout.fileno(), Screen()
    while not keyboard.leave:
        ready, _, _ = select.select([stdin, link], [], [])
        if link in ready:
            os.write(stdout, screen.feed(link.read(0)).encode())
        if stdin in ready:
            keys = _read_keys(stdin)
            if not keys:
                return
            link.write(keyboard.feed(keys))


def _read_keys(stdin: int) -> bytes:
    """The codes of the keys pressed; waits a moment for the rest of an arrow key."""
    keys = os.read(stdin, KEY_BYTES)
    if keys.endswith(ESC) and select.select([stdin], [], [], ESC_WAIT_S)[0]:
        keys += os.read(stdin, KEY_BYTES)
    return keys


@contextmanager
def _raw_terminal() -> Iterator[None]:
    """Every key comes through as its byte; the former state is restored."""
    import termios
    import tty

    stdin = sys.stdin.fileno()
    before = termios.tcgetattr(stdin)
    tty.setraw(stdin)
    try:
        yield
    finally:
        termios.tcsetattr(stdin, termios.TCSADRAIN, before)


def _history_file() -> Path:
    import platformdirs

    return platformdirs.user_state_path("openacr") / "term_history"


def _load_history() -> "History":
    """Lines of earlier sessions; a missing or unreadable file is an empty history."""
    from openacr.io.keyboard import History

    try:
        return History(_history_file().read_bytes().splitlines())
    except OSError:
        return History()


def _save_history(lines: list[bytes]) -> None:
    """Keep the lines for the next session; a read-only home is no reason to fail."""
    path = _history_file()
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(b"\n".join(lines) + b"\n")
    except OSError as failure:
        typer.echo(f"history not saved: {failure}", err=True)
