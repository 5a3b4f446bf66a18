"""A jog of any axis of a card, of whatever master: while a key is held, or by a distance.

The target is at most `LEASH_S` of travel at full speed and the braking distance ahead, and moves on
only while `step` is called: an axis whose host or link is lost comes to rest by itself. At rest the
jog offset becomes position (JOG RES) and the axis has its own jog speed again; where the host was
lost before, `set_back` does that later.
"""

import math
from collections.abc import Callable
from contextlib import suppress
from typing import NamedTuple

from openacr.client.card import Card
from openacr.client.errors import RefusedError
from openacr.client.values import number_text
from openacr.errors import UserError
from openacr.map.rows import axes
from openacr.map.words import af1, af4, mf1, pf

LEASH_S, RENEW_S = 0.5, 0.1
SAME = 1e-5  # the card keeps a speed with seven digits
PAUSED = pf.PAUSE_CONTROL | pf.PAUSE_MODE
MOVES = mf1.IN_MOTION | mf1.MOVE_BUFFERED
OFFSETS = af1.JOG_ACTIVE | af1.GEAR_ACTIVATE | af1.GEAR_ACTIVE | af1.CAM_ACTIVATE


class Jogged(NamedTuple):
    """An axis that is to be jogged, and what else may move it."""

    axis: int
    name: str
    master: int | None = None
    programs: tuple[int, ...] = ()  # that have this master


class AxisJog:
    """One jog of an axis; `step` until it `is_over`. UserError where the axis may not be jogged.

    `speed_ups` is in units of the axis a second, `distance_u` in its units; without one the axis
    moves until `release`.
    """

    def __init__(
        self,
        card: Card,
        jogged: Jogged,
        direction: int,
        speed_ups: float,
        now_s: float,
        *,
        distance_u: float | None = None,
        note: Callable[[float], None] = lambda _own_ups: None,
    ) -> None:
        """Begin to move; `note` gets the jog speed of the axis before it is changed."""
        self.name, self.axis = jogged.name, jogged.axis
        self.is_over = False
        self._card, self._direction = card, direction
        _require_free(card, jogged)
        ppu, self._own_ups, acc, dec = self._read(
            axes.ppu, axes.jog_veloc_setting, axes.jog_accel_setting, axes.jog_decel_setting
        )
        if acc <= 0.0 or dec <= 0.0:
            raise UserError(
                f"axis {self.name} has no jog ramps (JOG ACC {acc:g}, JOG DEC {dec:g}):"
                f" set both first, for example AXIS{self.axis} JOG DEC {10.0 * speed_ups:g}"
            )
        self._ppu = ppu or 1.0
        self._reach_u = LEASH_S * speed_ups + 0.5 * speed_ups**2 / dec
        self._end_u = None if distance_u is None else self._offset_u() + direction * distance_u
        self._is_led = True  # the target still moves on
        note(self._own_ups)
        self._type(f"JOG VEL {number_text(speed_ups)}")
        self._aim(now_s)

    def step(self, now_s: float) -> None:
        """Move the target on where it is time; at rest the axis has its own settings again.

        RefusedError where the card lets the axis go no further.
        """
        if self.is_over:
            return
        if self._is_led:
            if now_s >= self._renewed_s + RENEW_S:
                self._aim(now_s)
            return
        (word,) = self._read(af1.word)
        if not int(word) & af1.JOG_ACTIVE:
            self._settle()

    def release(self) -> None:
        """Ramp the axis to rest."""
        if not self.is_over:
            self._is_led = False
            self._type("JOG OFF")

    def leave(self) -> None:
        """The session ends: the axis ramps to rest by itself, its own speed counts again."""
        if not self.is_over:
            self.is_over = True
            self._type("JOG OFF", f"JOG VEL {number_text(self._own_ups)}")

    def _aim(self, now_s: float) -> None:
        target_u = self._offset_u() + self._direction * self._reach_u
        end_u = self._end_u
        if end_u is not None and (target_u - end_u) * self._direction >= 0.0:
            target_u, self._is_led = end_u, False
        self._type(f"JOG ABS {number_text(target_u)}")
        self._renewed_s = now_s

    def _settle(self) -> None:
        self.is_over = True
        with suppress(RefusedError):  # a program moves the axis by now: its offset stays
            self._type("JOG RES")
        self._type(f"JOG VEL {number_text(self._own_ups)}")

    def _offset_u(self) -> float:
        return self._read(axes.jog_offset)[0] / self._ppu

    def _read(self, *rows: tuple[int, ...]) -> list[float]:
        return [float(value) for value in self._card.read_many([row[self.axis] for row in rows])]

    def _type(self, *commands: str) -> None:
        for command in commands:
            self._card.command(f"AXIS{self.axis} {command}", program=0)


def set_back(card: Card, jogged: Jogged, own_ups: float, speed_ups: float) -> str | None:
    """End what is left of a jog with `speed_ups` whose host was lost; what was done, in words.

    None while the axis moves, or its master has a move or a program that runs or is paused: its
    targets would shift. Nothing is done ("") where another host has set a jog speed since.
    """
    axis, name, master, programs = jogged
    watched = [] if master is None else [mf1.word[master]]
    rows = [af1.word[axis], axes.jog_veloc_setting[axis], axes.jog_offset[axis], axes.ppu[axis]]
    moved, found_ups, offset, ppu, *words = card.read_many(
        [*rows, *watched, *(pf.word[n] for n in programs)]
    )
    moves, running = words[: len(watched)], words[len(watched) :]
    if int(moved) & OFFSETS or any(int(word) & MOVES for word in moves):
        return None
    if any(int(word) & pf.PROGRAM_RUNNING for word in running):
        return None
    if not any(math.isclose(found_ups, ups, rel_tol=SAME) for ups in (own_ups, speed_ups)):
        return ""
    card.command(f"AXIS{axis} JOG VEL {number_text(own_ups)}", program=0)
    card.command(f"AXIS{axis} JOG RES", program=0)
    return (
        f"axis {name}: a jog was cut off before its end; its offset {offset / (ppu or 1.0):g} is"
        f" position now (JOG RES), its jog speed is {own_ups:g} again"
    )


def _require_free(card: Card, jogged: Jogged) -> None:
    """Refuse an axis that the card would not move, or that something else moves or may move."""
    axis, name, master, programs = jogged
    masters = [] if master is None else [master]
    values = card.read_many(
        [
            af1.word[axis], af4.word[axis], *(mf1.word[n] for n in masters),
            *(pf.word[n] for n in programs),
        ]
    )  # fmt: skip
    moved, drive, *rest = map(int, values)
    if drive & af4.DRIVE_I_O_ENABLE and not drive & af4.DRIVE_ENABLED:
        raise UserError(f"the drive of axis {name} is off: DRIVE ON {name} switches it on")
    if drive & af4.KILL_ALL_MOTION_REQUEST:
        raise UserError(f"the motion of axis {name} is killed: DRIVE ON {name} lifts the kill")
    if moved & OFFSETS:
        raise UserError(f"axis {name} is still moving: press again when it rests")
    if any(word & MOVES for word in rest[: len(masters)]):
        raise UserError(f"MASTER{master} has a move under way: wait until axis {name} rests")
    for program, word in zip(programs, rest[len(masters) :], strict=True):
        if word & pf.PROGRAM_RUNNING and not word & PAUSED:
            raise UserError(f"PROG{program} runs and may move axis {name}: STOP or HALT it first")
