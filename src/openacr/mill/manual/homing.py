"""Homing of axes: to the switch, off it, to the encoder marker, back to the marker.

Every axis runs through the same steps independently; axes of one priority run at once. An
axis that fails stays un-homed and raises alarm 34.

The axis moves as a jog, whose ramps and speeds belong to homing for that time only. At the
end the jog offset is folded into the position and the position is set to Home Preset.
"""

from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack
from itertools import groupby
from math import copysign, inf
from typing import TypeAlias

from openacr.client.values import number_text
from openacr.map.rows import axes as axis_rows
from openacr.map.words import af1, af4
from openacr.mill.card import alarms, homed
from openacr.mill.card.actions import Steps, Until
from openacr.mill.card.alarms import AlarmError
from openacr.mill.card.ballscrew import Compensation
from openacr.mill.card.driver import CardState, flag_of
from openacr.mill.card.machine_io import MachineIo
from openacr.mill.config.tabs import AxisSettings, HomeSettings

FIRST_MARKER = 0  # INTCAP mode: rising edge of the marker of the axis' own encoder
TRAVEL_SHARE, TRAVEL_U = 1.1, 1000.0
BEYOND_SHARE = 1.05  # of the longest travel: the distance an axis is sent
STALLED_MS = 3000  # longest standstill of an axis that is commanded to move

Condition: TypeAlias = Callable[[CardState], bool]


def groups(io: MachineIo, axes: Iterable[int]) -> Iterator[list[int]]:
    """Group axes by ascending priority; priority 0 is left out."""
    priority = {axis: io.settings.home(axis).priority for axis in axes}
    chosen = sorted((axis for axis in priority if priority[axis] > 0), key=priority.__getitem__)
    for _, group in groupby(chosen, priority.__getitem__):
        yield list(group)


class _Side:
    """One of several actions that run in parallel."""

    def __init__(self, path: Steps) -> None:
        self.path = path
        self.until = next(path, None)

    def advance(self, sample: CardState) -> bool:
        """Run the action until it has to wait; returns whether it has ended."""
        while self.until is not None and self.until.is_met(sample):
            self.until = next(self.path, None)
        return self.until is None


def together(
    actions: Iterable[Steps],
    reason: str,
    note: Callable[[int, str | None], None] = lambda _place, _reason: None,
) -> Steps:
    """Run several actions in parallel, until all of them have ended.

    `note` gets the place of each action and what it waits for, None once it has ended.
    """
    sides = [_Side(path) for path in actions]

    def are_over(sample: CardState) -> bool:
        left = sum(not side.advance(sample) for side in sides)
        for place, side in enumerate(sides):
            note(place, side.until.reason if side.until is not None else None)
        return not left

    try:
        yield Until(reason, are_over)
    finally:
        with ExitStack() as each:  # all of them, even if one fails to stop its axis
            for side in sides:
                each.callback(side.path.close)


class Axis:
    """Homing of one axis."""

    def __init__(self, io: MachineIo, axis: AxisSettings) -> None:
        self._machine = io.machine
        self._io = io
        self._axis = axis
        self._row: HomeSettings = io.settings.home(axis.index)

    @property
    def outlook(self) -> str:
        """Announcement of the direction and longest travel, for the operator."""
        distance_u, sign = BEYOND_SHARE * self._longest_u(), "-" if self._row.is_negative else "+"
        switch = f"its switch at input {self._row.switch_input}"
        return f"{self._axis.name}: {sign} to {switch}, at most {distance_u:g} units"

    def home(self) -> Steps:
        """Home the axis: at the end it is at rest and its position is set."""
        if not self._io.has_input(self._row.switch_input):
            raise AlarmError(alarms.HOMING_FAILED, f"{self._axis.name}: no switch input configured")
        self._ramps(self._row.acc_ups2, self._row.dec_ups2)
        try:
            yield from self._switch()
            yield from self._marker()
        except BaseException:  # cancelled by STOP or ABORT, or failed
            try:
                self._ramps(self._row.acc_ups2, self._row.stp_ups2)
            finally:
                self._jog(0.0)
            raise
        self._ramps(self._axis.jog_acc_ups2, self._axis.jog_dec_ups2)
        self._type(f"JOG RES {self._axis.name}0")
        self._type(f"RES {self._axis.name}{number_text(self._row.preset_u)}")

    def _switch(self) -> Steps:
        row = self._row
        to_switch = -1.0 if row.is_negative else 1.0
        if not self._io.is_in(self._machine.poll(), row.switch_input):
            self._jog(to_switch * row.fast_ups)
            yield self._until("switch", is_on=True)
        self._jog(0.0)
        yield self._rest()
        self._jog(-to_switch * row.slow_ups)
        yield self._until("release of the switch", is_on=False)

    def _marker(self) -> Steps:
        row = self._row
        away = 1.0 if row.is_negative else -1.0
        self._type(f"INTCAP {self._axis.name} {FIRST_MARKER}")
        self._jog(away * row.marker_ups)
        captured = self._flag(af1.word, af1.CAPTURE_COMPLETE)
        yield self._supervised("marker", lambda _sample: self._is_set(captured))
        self._jog(0.0)
        yield self._rest()
        point = self._machine.read(self._parameter(axis_rows.hardware_capture))
        actual = self._machine.read(self._parameter(axis_rows.actual_position))
        back_u = (point - actual) / self._axis.pulses_per_unit
        self._type(f"JOG VEL {self._axis.name}{number_text(row.marker_ups)}")
        self._type(f"JOG INC {self._axis.name}{number_text(back_u)}")
        yield self._rest()

    # --- helpers -----------------------------------------------------------------------

    def _until(self, what: str, *, is_on: bool) -> Until:
        number = self._row.switch_input
        return self._supervised(what, lambda sample: self._io.is_in(sample, number) == is_on)

    def _supervised(self, what: str, is_met: Condition) -> Until:
        """A wait for a condition, limited to the longest travel and to a moving axis."""
        start = last = self._machine.read(self._parameter(axis_rows.actual_position))
        longest = self._longest_u() * self._axis.pulses_per_unit
        moved_ms: int | None = None

        def check(sample: CardState) -> bool:
            nonlocal last, moved_ms
            if is_met(sample):
                return True
            actual = self._machine.read(self._parameter(axis_rows.actual_position))
            if abs(actual - start) > abs(longest) or self._is_barred(sample):
                raise AlarmError(alarms.HOMING_FAILED, f"{self._axis.name}: no {what}")
            if actual != last or moved_ms is None:
                last, moved_ms = actual, sample.clock_ms
            elif sample.clock_ms - moved_ms > STALLED_MS:
                raise AlarmError(
                    alarms.HOMING_FAILED,
                    f"{self._axis.name}: no motion (is its drive on?)",
                )
            return False

        return Until(f"homing {self._axis.name}: {what}", check, inf)

    def _is_barred(self, sample: CardState) -> bool:
        """Whether the card has stopped the axis, at a limit or by a kill."""
        word = sample.drives[self._machine.axes.index(self._axis.index)]
        return bool(word & af4.KILL_ALL_MOTION_REQUEST)

    def _longest_u(self) -> float:
        limits = self._axis.soft_limits
        return TRAVEL_SHARE * (limits[0] - limits[1]) if limits else TRAVEL_U

    def _rest(self) -> Until:
        active = self._flag(af1.word, af1.JOG_ACTIVE)
        reason = f"homing {self._axis.name}: rest"
        return Until(reason, lambda _sample: not self._is_set(active))

    def _ramps(self, acc_ups2: float, dec_ups2: float) -> None:
        self._type(f"JOG ACC {self._axis.name}{number_text(acc_ups2)}")
        self._type(f"JOG DEC {self._axis.name}{number_text(dec_ups2)}")

    def _jog(self, speed_ups: float) -> None:
        """Jog at a signed speed; 0 ramps down.

        The distance is slightly more than the longest travel: the axis stops by itself when
        the host or the link is lost.
        """
        name = self._axis.name
        if speed_ups == 0.0:
            self._type(f"JOG OFF {name}")
            return
        distance_u = copysign(BEYOND_SHARE * self._longest_u(), speed_ups)
        self._type(f"JOG VEL {name}{number_text(abs(speed_ups))}")
        self._type(f"JOG INC {name}{number_text(distance_u)}")

    def _type(self, line: str) -> None:
        self._machine.type([line])

    def _parameter(self, row: tuple[int, ...]) -> int:
        return row[self._axis.index]

    def _flag(self, word: tuple[int, ...], mask: int) -> int:
        return flag_of(word[self._axis.index], mask)

    def _is_set(self, flag: int) -> bool:
        return self._machine.card.read_bit(flag)


def home(
    io: MachineIo,
    axes: Iterable[int],
    compensation: Compensation,
    say: Callable[[str], None],
    progress: dict[int, str] | None = None,
) -> Steps:
    """Home the selected axes in order of priority, and record in the store which are homed.

    The longest travel of each is announced first, since its switch may not be wired.
    `progress` gets for each axis what it waits for: waiting, switch, release of the switch,
    marker, rest, done.
    """
    chosen = list(groups(io, axes))
    shown = {} if progress is None else progress
    shown.clear()
    shown.update((axis, "waiting") for group in chosen for axis in group)
    for group in chosen:
        homing = [Axis(io, io.settings.axis(axis)) for axis in group]
        for each in homing:
            say(each.outlook)
        actions = [each.home() for each in homing]
        for axis in group:
            homed.note(io, axis, False)
        compensation.renew()
        names = " ".join(io.settings.axis(axis).name for axis in group)

        def note(place: int, reason: str | None, group: list[int] = group) -> None:
            shown[group[place]] = "done" if reason is None else reason.partition(": ")[2]

        yield from together(actions, f"homing {names}", note)
        for axis in group:
            homed.note(io, axis, True)
        compensation.renew()
