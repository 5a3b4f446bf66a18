"""ATTACH and DETACH: masters, slaves and the feedback and output of an axis."""

from enum import IntEnum

from openacr.errors import CardError
from openacr.map.rows import axes, masters
from openacr.messages import (
    AXIS_ALREADY_ATTACHED,
    ILLEGAL_NAME,
    INVALID_ARGUMENT,
    MASTER_ALREADY_ATTACHED,
    NO_MASTER_ATTACHED,
    NOT_VALID_WHILE_IN_MOTION,
    SLAVE_ALREADY_ATTACHED,
)
from openacr.motion.attachments import Slave
from openacr.motion.card import Card
from openacr.motion.interlocks import master_moving, needs_rest

NAME_LENGTH = 4
RESERVED_NAMES = frozenset({"P", "F"})


class Feedback(IntEnum):
    """What an axis takes its position or velocity from; the numbers are the kernel's."""

    ENC = 0
    ADC = 1
    STEPPER = 2


class Signal(IntEnum):
    """What an axis puts its output out on; the numbers are the kernel's."""

    DAC = 0
    STEPPER = 1
    CMT = 2


def master(card: Card, program: int, number: int) -> None:
    """ATTACH MASTER: give a program its master."""
    if not 0 <= number < card.model.masters:
        raise CardError(INVALID_ARGUMENT)
    attachments = card.attachments
    if attachments.master(program) is not None or attachments.program(number) is not None:
        raise CardError(MASTER_ALREADY_ATTACHED)
    attachments.put_master(program, number)
    card.memory.I[masters.program[number]] = program


def slave(card: Card, program: int, number: int, axis: int, name: str) -> None:
    """ATTACH SLAVE: give a master an axis, under a name known to its program."""
    if not (0 <= number < card.model.slaves and 0 <= axis < card.model.axes):
        raise CardError(INVALID_ARGUMENT)
    if not _is_legal(name):
        raise CardError(ILLEGAL_NAME)
    owner = card.attachments.master(program)
    if owner is None:
        raise CardError(NO_MASTER_ATTACHED)
    slaves = card.attachments.slaves(program)
    if any(other.number == number for other in slaves):
        raise CardError(SLAVE_ALREADY_ATTACHED)
    if card.attachments.owner(axis) is not None:
        raise CardError(AXIS_ALREADY_ATTACHED)
    if any(other.name.upper() == name.upper() for other in slaves):
        raise CardError(ILLEGAL_NAME)
    card.attachments.put_slave(program, Slave(number, axis, name))
    rows = card.memory.I
    rows[masters.slave_axis[owner] + number] = axis
    rows[axes.master[axis]] = owner
    rows[axes.slave[axis]] = number
    position = card.memory.F[axes.position_cnt[axis]]
    card.memory.F[masters.target_cnt[owner] + number] = position


def _is_legal(name: str) -> bool:
    return (
        0 < len(name) <= NAME_LENGTH
        and name.isascii()
        and name.isalpha()
        and name.upper() not in RESERVED_NAMES
    )


def axis(
    card: Card,
    number: int,
    position: tuple[Feedback, int],
    signal: tuple[Signal, int],
    velocity: tuple[Feedback, int] | None = None,
) -> None:
    """ATTACH AXIS: choose feedback and output of an axis; velocity defaults to position."""
    if not 0 <= number < card.model.axes:
        raise CardError(INVALID_ARGUMENT)
    velocity = velocity or position
    for feedback in (position, velocity):
        _check(feedback[1], _feedback_count(card, feedback[0]))
    _check(signal[1], _signal_count(card, signal[0]))
    needs_rest(card, number)
    rows = card.memory.I
    rows[axes.position_source[number]], rows[axes.position_index[number]] = position
    rows[axes.signal_source[number]], rows[axes.signal_index[number]] = signal
    rows[axes.velocity_source[number]], rows[axes.velocity_index[number]] = velocity
    rows[axes.drive_wired[number]] = -1  # another motor may be connected to it


def _check(index: int, count: int) -> None:
    if not 0 <= index < count:
        raise CardError(INVALID_ARGUMENT)


def _feedback_count(card: Card, kind: Feedback) -> int:
    counts = {Feedback.ENC: card.model.encoders, Feedback.ADC: card.model.adcs}
    return counts.get(kind, card.model.axes)


def _signal_count(card: Card, kind: Signal) -> int:
    return {Signal.DAC: card.model.dacs, Signal.CMT: card.model.commutators}.get(
        kind, card.model.axes
    )


def detach(card: Card, program: int) -> None:
    """DETACH: free all slaves and the master of a program."""
    number = card.attachments.master(program)
    if number is None:
        return
    _needs_idle(card, number)
    for item in card.attachments.slaves(program):
        _free_slave(card, number, item)
    card.memory.I[masters.program[number]] = -1
    card.attachments.drop_program(program)


def detach_slave(card: Card, program: int, number: int) -> None:
    """DETACH SLAVE: free one axis."""
    owner = card.attachments.master(program)
    if owner is None:
        raise CardError(NO_MASTER_ATTACHED)
    _needs_idle(card, owner)
    for item in card.attachments.slaves(program):
        if item.number == number:
            _free_slave(card, owner, item)
            card.attachments.drop_slave(program, number)


def detach_master(card: Card, number: int) -> None:
    """DETACH MASTER: free a master and its slaves, whichever program attached them."""
    program = card.attachments.program(number)
    if program is not None:
        detach(card, program)


def detach_all(card: Card) -> None:
    """DETACH ALL: free the masters and slaves of all programs, or none if one moves."""
    for number in range(card.model.masters):
        if card.attachments.program(number) is not None:
            _needs_idle(card, number)
    for program in range(card.model.programs):
        detach(card, program)


def _needs_idle(card: Card, number: int) -> None:
    if master_moving(card, number):
        raise CardError(NOT_VALID_WHILE_IN_MOTION)


def _free_slave(card: Card, owner: int, item: Slave) -> None:
    card.memory.I[masters.slave_axis[owner] + item.number] = -1
    card.memory.I[axes.master[item.axis]] = -1


def report_program(card: Card, program: int) -> list[str]:
    """What ATTACH prints at a program: one line per attachment."""
    number = card.attachments.master(program)
    if number is None:
        return []
    lines = [f"ATTACH MASTER{number}"]
    for item in card.attachments.slaves(program):
        lines.append(f'ATTACH SLAVE{item.number} AXIS{item.axis} "{item.name}"')
    return lines


def report_axis(card: Card, number: int) -> str:
    """The ATTACH AXIS line of one axis."""
    rows = card.memory.I
    position = Feedback(rows[axes.position_source[number]]).name
    signal = Signal(rows[axes.signal_source[number]]).name
    velocity = Feedback(rows[axes.velocity_source[number]]).name
    return (
        f"ATTACH AXIS{number} {position}{rows[axes.position_index[number]]}"
        f" {signal}{rows[axes.signal_index[number]]} {velocity}{rows[axes.velocity_index[number]]}"
    )


def report_system(card: Card) -> list[str]:
    """What ATTACH prints at SYS: the attachment of every axis."""
    return [report_axis(card, number) for number in range(card.model.axes)]
