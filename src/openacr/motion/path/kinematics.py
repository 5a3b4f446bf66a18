"""INVK: masters whose path is that of a tool, and whose axes are joints.

The coordinated positions of the slaves are those of the tool; what the joints are off is a
part of its own of the setpoints (kernel/axis/axis_cy.py). The program that computes the joints
is the language's business (basic/vm/kinematics_cy.py).
"""

from openacr.compiled import pick
from openacr.errors import CardError
from openacr.kernel.axis import axis_cy
from openacr.map.rows import axes, kernel, masters
from openacr.map.words import mf4
from openacr.messages import NOT_VALID_WHILE_IN_MOTION
from openacr.motion.card import Card
from openacr.motion.interlocks import axes_of, master_moving

_MASK = kernel.kinematics
_axis_settled = pick(axis_cy.axis_settled)


def program_of(card: Card, master: int) -> int | None:
    """The program that computes the joints of a master, None before one is chosen."""
    program = card.memory.I[masters.invk_program[master]] - 1
    return program if program >= 0 else None


def choose(card: Card, master: int, program: int) -> None:
    """INVK PROGn."""
    card.memory.I[masters.invk_program[master]] = program + 1


def is_on(card: Card, master: int) -> bool:
    """Whether the axes of a master are joints now."""
    return bool(card.memory.I[_MASK] >> master & 1)


def needs_rest(card: Card, master: int) -> None:
    """Refuse while the master has a move."""
    if master_moving(card, master):
        raise CardError(NOT_VALID_WHILE_IN_MOTION)


def switch_on(card: Card, master: int) -> None:
    """INVK ON: the tool is said to be where the joints are until a program writes otherwise."""
    for axis in axes_of(card, master):
        card.memory.F[axes.seen_cnt[axis]] = card.memory.F[axes.position_cnt[axis]]
    card.memory.I[masters.invk_moving[master]] = 0
    card.memory.I[_MASK] |= 1 << master
    card.memory.I[mf4.word[master]] |= mf4.PERFORM_KINEMATICS


def switch_off(card: Card, master: int) -> None:
    """INVK OFF: the coordinated positions are those of the joints again; nothing moves."""
    card.memory.I[_MASK] &= ~(1 << master)
    card.memory.I[mf4.word[master]] &= ~mf4.PERFORM_KINEMATICS
    for axis in axes_of(card, master):
        card.memory.F[axes.position_cnt[axis]] += card.memory.F[axes.kinematics_cnt[axis]]
        card.memory.F[axes.kinematics_cnt[axis]] = 0.0
        _axis_settled(card.memory.F, card.memory.I, axis)
