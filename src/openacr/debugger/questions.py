"""Values of expressions as the card itself gives them, without a trace on it."""

from __future__ import annotations

from openacr.controller.controller import Controller
from openacr.controller.streams import CONSOLE
from openacr.debugger.calls import PROGRAMS
from openacr.errors import UserError


def answer(card: Controller, owner: int, expression: str) -> str:
    """What `?expression` shows at the prompt of a program; UserError with the card's message."""
    with card.aside():
        text = _type(card, owner, f"?{expression}")
    if not text:
        raise UserError(f"{expression}: the card gives no value")
    return text


def assign(card: Controller, owner: int, target: str, value: str) -> None:
    """Type an assignment at the prompt of a program; UserError with the card's message."""
    _type(card, owner, f"{target}={value}")


def typed(card: Controller, owner: int, line: str) -> str:
    """What the card answers to a line that is typed at the prompt of a program.

    What it prints later (a program, a wait) is shown as output.
    """
    card.send(f"PROG{owner if owner < PROGRAMS else 0}\r")
    answer = card.send(f"{line}\r")
    return answer.partition("\r\n")[2].replace("\r\n", "\n")


def heard(card: Controller) -> str:
    """What the card has answered since to the lines that were typed."""
    console = card.streams.number_of(CONSOLE)
    if console is None:
        return ""
    return b"".join(iter(lambda: card.take_output(console), b"")).decode("latin-1")


def run_program(card: Controller, program: int) -> None:
    """Start a program as RUN does; UserError with the card's message."""
    _type(card, program, "RUN")


def _type(card: Controller, owner: int, line: str) -> str:
    """The answer to a line typed at the prompt of a program (of PROG0 for a PLC)."""
    if any(not 32 <= ord(character) <= 255 for character in line):
        raise UserError(f"{line!r} cannot be typed at a card: it has characters beyond Latin-1")
    session = card.system.sessions[CONSOLE]
    card.send(f"PROG{owner if owner < PROGRAMS else 0}\r")
    session.last_error = None
    typed = card.send(f"{line}\r")
    if session.last_error is not None:
        raise UserError(f"{line}: {session.last_error.text}")
    return "\r\n".join(typed.split("\r\n")[1:-1])
