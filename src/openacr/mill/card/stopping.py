"""Stop of a machine that any program may drive: outputs off, all motion to rest, then barred."""

from contextlib import suppress
from dataclasses import dataclass

from openacr.client import Card
from openacr.client.errors import RefusedError
from openacr.client.standstill import WATCH_S, Standstill
from openacr.mill.card.alarms import Kind
from openacr.mill.card.kill_cause import cause_of
from openacr.mill.card.leftovers import machine_of, switch_off
from openacr.mill.card.machine_io import MachineIo
from openacr.mill.card.watchdog import NAME as WATCHDOG
from openacr.mill.config.settings import NONE, Settings

FIRST_LINES = "LIST -20"  # where its name is; a long program takes seconds over a slow line


def watching(card: Card, settings: Settings) -> set[int]:
    """Programs of the card that watch over its host: no stop ends them."""
    program = settings.watchdog_program
    if program == NONE:
        return set()
    listed = card.command(FIRST_LINES, program=program)
    return {program} if listed and WATCHDOG in listed[0] else set()


@dataclass(frozen=True, slots=True)
class Stopped:
    """Result of a stop."""

    moved: list[str]  # what was held or ended on the card
    found: list[str]  # outputs that were on
    rests: bool  # at rest without switching the drives off
    cause: Kind | None  # of an earlier kill of all motion, where known


def stop_all(card: Card, settings: Settings) -> Stopped:
    """Stop the machine and switch spindle, coolant and beam off.

    Ownership is not required. Moves stay killed, so that a host that still runs ends its
    program, and nothing moves before an acknowledgement.
    """
    machine = machine_of(card, settings)
    machine.hold()
    everything = Standstill(
        card, ends=True, spared=watching(card, settings), of_host={machine.master}
    )
    everything.look()
    found = switch_off(card, settings)
    for line in (f"HALT PROG{machine.master}", *(f"AXIS{axis} JOG OFF" for axis in machine.axes)):
        with suppress(RefusedError):
            machine.type([line])
    cause = cause_of(MachineIo(machine, settings), machine.poll())  # before moves are killed here
    machine.stop()

    def is_at_rest() -> bool:
        everything.look()
        sample = machine.poll()
        is_still = (sample.is_held or not sample.is_moving) and not machine.is_jogging()
        return is_still and not everything.moving and everything.is_over

    rests = card.wait(is_at_rest, timeout_s=max(settings.rest_s, 2 * WATCH_S))
    if not rests:
        machine.disable()
    machine.bar()
    return Stopped(everything.found, found, rests, cause)
