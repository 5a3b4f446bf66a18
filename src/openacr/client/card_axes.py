"""How the axes of a card are attached to the masters of its programs: only read."""

from dataclasses import replace

from openacr.client.effects import Op
from openacr.client.errors import RefusedError
from openacr.client.requests import Level
from openacr.client.talk import Talk
from openacr.lang.attachments import Attached, attachments

PROGRAMS = 16


def attached(talk: Talk) -> Op[list[Attached]]:
    """The axes of all masters; none of a card that does not list them."""
    home = talk.level
    found: list[Attached] = []
    for program in range(PROGRAMS):
        try:
            lines = yield from talk.query("ATTACH", at=Level.program(program))
        except RefusedError:  # it has no memory, or the card does not list them
            continue
        found += [replace(each, program=program) for each in attachments(lines)[1]]
    yield from talk.go(home)
    return found
