"""Cleanup after a program that ended without its shutdown: held moves, outputs that are on."""

from collections.abc import Callable

from openacr.client import Card
from openacr.cnc.occupied import TRIPPED
from openacr.errors import UserError
from openacr.mill.card.actions import DAC_STRIDE, DAC_VALUE
from openacr.mill.card.driver import MachineDriver
from openacr.mill.card.machine_io import MachineIo
from openacr.mill.card.watchdog import left_text
from openacr.mill.config.settings import NONE, Settings

LIMIT_S = 5.0  # for dropping held moves


def has_tripped(card: Card) -> bool:
    """Whether the watchdog has stopped the machine and this is not acknowledged."""
    return card.read_bit(TRIPPED)


def machine_of(card: Card, settings: Settings) -> MachineDriver:
    """The driver for the axes of the machine on this card."""
    return MachineDriver(card, [axis.index for axis in settings.axes], settings.master)


def tidy(card: Card, settings: Settings, say: Callable[[str], None], *, was_left: bool) -> None:
    """Report and switch off what an earlier program left on; called before the set-up.

    A machine that still moves is left unchanged, with its outputs.
    """
    is_tripped = has_tripped(card)
    if not is_tripped and not was_left:
        return
    machine = machine_of(card, settings)
    text = left_text(card, settings.watchdog_program) if is_tripped else ""
    if text:
        say(f"the watchdog has stopped the machine: {text}")
    sample = machine.poll()
    if sample.is_moving and sample.is_held:
        say("held moves of an earlier program are dropped")
        machine.stop()
        if not card.wait(lambda: not machine.poll().is_moving, timeout_s=LIMIT_S):
            raise UserError("held moves of an earlier program stay: use openacr mill stop")
        machine.clear_kill()
    elif sample.is_moving or machine.is_jogging():
        return  # `check_rest` refuses it
    for text in switch_off(card, settings):
        say(f"left on by an earlier program, switched off: {text}")


def switch_off(card: Card, settings: Settings) -> list[str]:
    """Switch spindle, coolant and beam off; returns what was on."""
    io = MachineIo(machine_of(card, settings), settings)
    levels = io.safe_levels()
    before = card.read_bits([number for number, _ in levels])
    found = []
    for (number, off), was in zip(levels, before, strict=True):
        io.machine.set_flag(number, off)
        if was != off:
            found.append(f"output {number}")
    if settings.spindle.dac != NONE:
        dac = DAC_VALUE + DAC_STRIDE * settings.spindle.dac
        if card.read(dac):
            found.append(f"DAC{settings.spindle.dac}")
        card.write(dac, 0)
    return found
