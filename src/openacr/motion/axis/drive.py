"""DRIVE ON, OFF and RES, and the control keys that kill and release motion."""

from openacr.compiled import pick
from openacr.kernel.axis import drive_cy
from openacr.map.rows import axes
from openacr.map.words import af4, af5, mf1
from openacr.motion.axis import registers
from openacr.motion.card import Card
from openacr.motion.interlocks import axes_of, master_of, needs_rest

_drive_disable = pick(drive_cy.drive_disable)
_drive_barred = pick(drive_cy.drive_barred)
_drive_driven = pick(drive_cy.drive_driven)

ENABLE_S = 0.01  # from the command to the status flag
LIMIT_LATCHES = (
    af5.POSITIVE_HARDWARE_LIMIT_ENCOUNTERED
    | af5.NEGATIVE_HARDWARE_LIMIT_ENCOUNTERED
    | af5.POSITIVE_SOFTWARE_LIMIT_ENCOUNTERED
    | af5.NEGATIVE_SOFTWARE_LIMIT_ENCOUNTERED
)


def is_enabled(card: Card, axis: int) -> bool:
    """Whether the drive of an axis reports enabled."""
    return bool(card.memory.I[af4.word[axis]] & af4.DRIVE_ENABLED)


def is_driven(card: Card, axis: int) -> bool:
    """Whether the drive of an axis lets it put out anything."""
    return bool(_drive_driven(card.memory.I, axis))


def confirm(card: Card, axis: int) -> None:
    """The drive of an axis operates: Drive Enabled is set, unless something bars it."""
    rows = card.memory.I
    rows[axes.enable_ticks[axis]] = 0
    if not _drive_barred(rows, axis):
        rows[af4.word[axis]] |= af4.DRIVE_ENABLED | af4.MOTOR_ON
        rows[axes.drive_old[axis]] = af4.DRIVE_ENABLED


def has_fault(card: Card, axis: int) -> bool:
    """Whether a drive fault or an excess error is latched."""
    return bool(card.memory.I[af4.word[axis]] & (af4.DRIVE_FAULT | af4.EXCESS_ERROR_FAULT))


def on(card: Card, axis: int) -> None:
    """DRIVE ON: lift everything that bars the axis from moving, then enable the drive."""
    needs_rest(card, axis)
    if is_enabled(card, axis):
        return
    _lift(card, axis)
    registers.ren(card, axis)
    has_enable = card.memory.I[af4.word[axis]] & af4.DRIVE_I_O_ENABLE
    ticks = card.clock.ticks(ENABLE_S) if has_enable else 1
    card.memory.I[axes.enable_ticks[axis]] = ticks


def _lift(card: Card, axis: int) -> None:
    """Clear kills of the axis and its master group, and the latches of the axis."""
    rows = card.memory.I
    master = master_of(card, axis)
    for other in [axis] if master is None else axes_of(card, master):
        rows[af4.word[other]] &= ~af4.KILL_ALL_MOTION_REQUEST
    if master is not None:
        rows[mf1.word[master]] &= ~mf1.KILL_ALL_MOVES_REQUEST
    rows[af4.word[axis]] &= ~(af4.DRIVE_FAULT | af4.EXCESS_ERROR_FAULT)
    rows[af5.word[axis]] &= ~LIMIT_LATCHES


def off(card: Card, axis: int) -> None:
    """DRIVE OFF: the enable output goes off; no kill is set."""
    needs_rest(card, axis)
    disable(card, axis)


def disable(card: Card, axis: int) -> None:
    """Switch the drive of an axis off, moving or not."""
    _drive_disable(card.memory.I, axis)
    card.memory.I[axes.drive_old[axis]] = 0  # or the kernel would undo a DRIVE ON of this tick


def reset(card: Card, axis: int) -> None:
    """DRIVE RES: pulse the reset output for 50 ms; the fault latch clears."""
    card.memory.I[axes.reset_ticks[axis]] = 0
    card.memory.I[af4.word[axis]] &= ~af4.DRIVE_FAULT
    card.memory.I[af4.word[axis]] |= af4.DRIVE_RESET_REQUEST


def kill_all(card: Card) -> None:
    """Set the kill request of every axis (CTRL-X)."""
    for axis in range(card.model.axes):
        card.memory.I[af4.word[axis]] |= af4.KILL_ALL_MOTION_REQUEST


def clear_kills(card: Card) -> None:
    """Clear the kill requests of all axes and masters (CTRL-Y); nothing moves by it."""
    for axis in range(card.model.axes):
        card.memory.I[af4.word[axis]] &= ~af4.KILL_ALL_MOTION_REQUEST
    for master in range(card.model.masters):
        card.memory.I[mf1.word[master]] &= ~mf1.KILL_ALL_MOVES_REQUEST


def disable_all(card: Card) -> None:
    """Switch every drive off (the second half of CTRL-Z)."""
    for axis in range(card.model.axes):
        disable(card, axis)
