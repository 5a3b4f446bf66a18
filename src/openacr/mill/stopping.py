"""Stops a machine whoever drives it: everything off, moves and jogs to rest, then barred."""

from contextlib import suppress

from openacr.client import Card
from openacr.client.errors import RefusedError
from openacr.mill.leftovers import machine_of, switch_off
from openacr.mill.settings import Settings


def stop_all(card: Card, settings: Settings) -> tuple[list[str], bool]:
    """What was on, and whether the machine came to rest without losing its drives.

    Needs no ownership. Moves stay killed, so that a host that still runs ends its program
    and nothing moves before an acknowledgement.
    """
    machine = machine_of(card, settings)
    machine.hold()
    found = switch_off(card, settings)
    for line in (f"HALT PROG{machine.master}", *(f"AXIS{axis} JOG OFF" for axis in machine.axes)):
        with suppress(RefusedError):
            machine.type([line])
    machine.stop()

    def is_at_rest() -> bool:
        look = machine.look()
        return (look.is_held or not look.is_moving) and not machine.is_jogging()

    rests = card.wait(is_at_rest, timeout_s=settings.rest_s)
    if not rests:
        machine.disable()
    machine.bar()
    return found, rests
