"""Stops a machine whoever drives it: everything off, moves and jogs to rest, then barred."""

from contextlib import suppress
from dataclasses import dataclass

from openacr.client import Card
from openacr.client.errors import RefusedError
from openacr.mill.alarms import Kind
from openacr.mill.killed import cause_of
from openacr.mill.leftovers import machine_of, switch_off
from openacr.mill.panel import Panel
from openacr.mill.settings import Settings


@dataclass(frozen=True, slots=True)
class Stopped:
    """What a stop has found and done."""

    found: list[str]  # was on
    rests: bool  # without losing its drives
    cause: Kind | None  # why all motion had been killed before, where that is known


def stop_all(card: Card, settings: Settings) -> Stopped:
    """Bring the machine to rest with everything off.

    Needs no ownership. Moves stay killed, so that a host that still runs ends its program
    and nothing moves before an acknowledgement.
    """
    machine = machine_of(card, settings)
    machine.hold()
    found = switch_off(card, settings)
    for line in (f"HALT PROG{machine.master}", *(f"AXIS{axis} JOG OFF" for axis in machine.axes)):
        with suppress(RefusedError):
            machine.type([line])
    cause = cause_of(Panel(machine, settings), machine.look())  # before moves are killed here
    machine.stop()

    def is_at_rest() -> bool:
        look = machine.look()
        return (look.is_held or not look.is_moving) and not machine.is_jogging()

    rests = card.wait(is_at_rest, timeout_s=settings.rest_s)
    if not rests:
        machine.disable()
    machine.bar()
    return Stopped(found, rests, cause)
