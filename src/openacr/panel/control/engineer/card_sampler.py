"""Samples that a card at the end of a link records by itself (SAMP), record after record.

The card stores up to eight parameters in every servo period or at whole milliseconds, into arrays
of a program; these are read when they are full, and the next record begins. What happens while
they are read is not seen. Where the trigger is the edge of a flag, the card itself waits for it,
and nothing is read until it has come.

A card has one sampler. Its settings are compared before and after the arrays are read: what
another host has recorded is never taken for a record of the scope.
"""

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from openacr.errors import OpenacrError, UserError
from openacr.map import Flag, Parameter
from openacr.map import numbers as at
from openacr.map.block import Kind
from openacr.mill.card.driver import LINK_ERRORS
from openacr.mill.session import MillSession
from openacr.panel.control.engineer.sampling import row_of, value_in
from openacr.panel.control.engineer.scope import EITHER, Capture, Scope

ARMED = 104  # Sample Trigger Armed; the card clears it when an array is full
ARM = f"SET {ARMED} : PRINT 1"
MODE = 106  # Sample Mode Select: only while the trigger holds
POLL_S = 0.02
AT_ONCE = 1020  # elements read in one step: four packets
AT_ONCE_SERIAL = 32


@dataclass(frozen=True, slots=True)
class _Event:
    """A change of a flag, the trigger of the card."""

    flag: int
    is_set: bool

    @property
    def trigger(self) -> str:
        """The flag with its new state, for SAMP TRG."""
        return f"{'' if self.is_set else '-'}BIT{self.flag}"

    @property
    def is_ahead(self) -> str:
        """The condition in which the sampler is armed: it waits for a state, not for a change."""
        return f"BIT{self.flag}" + (" = 0" if self.is_set else "")


class CardSampler:
    """The sampler of a card and the arrays of one of its programs: LA0 to LA7, SA0 to SA7."""

    def __init__(self, session: MillSession, program: int, *, is_serial: bool = False) -> None:
        self._card, self._program = session.card, program
        self._at_once = AT_ONCE_SERIAL if is_serial else AT_ONCE
        self._room = 0  # elements of the shortest array
        self._settings: list[str] = []  # of the sampler, as the card reports them
        self._event: _Event | None = None
        self._reading: Iterator[None] | None = None
        self._poll_s = 0.0
        self._is_on = False  # the sampler has the settings of the scope
        self._is_armed = False

    def period_s(self, wanted_s: float) -> float:
        """Whole milliseconds; below half of one: the servo period of the card."""
        wanted_ms = round(1000.0 * wanted_s)
        return wanted_ms / 1000.0 if wanted_ms else float(self._lines("PERIOD")[0])

    def _lines(self, line: str) -> list[str]:
        return self._card.command(line, program=self._program)

    def begin(self, scope: Scope) -> None:
        """Set the sampler up; UserError where it is in use, or an array missing or too short."""
        capture = scope.running
        if capture is None:
            return
        names = [_array(place, each) for place, each in enumerate(capture.channels)]
        rooms = [self._card.array_length(self._program, name) for name in names]
        self._room = min(rooms)
        if self._room < capture.samples:
            name = names[rooms.index(self._room)]
            raise UserError(
                f"{name} of PROG{self._program} holds {self._room} samples, a sweep has"
                f" {capture.samples}: dimension it (DIM {name[:2]}(8), DIM {name}(COUNT)),"
                " or sweep faster"
            )
        if self._card.read_bit(ARMED):
            raise UserError("the sampler of the card is in use: SAMP CLEAR frees it")
        self._lines("SAMP CLEAR")
        for place, (name, each) in enumerate(zip(names, capture.channels, strict=True)):
            self._lines(f"SAMP {place} SRC P{row_of(each)}")
            self._lines(f"SAMP {place} BASE {name}")
        servo_s = float(self._lines("PERIOD")[0])
        every_s = 0.0 if capture.period_s == servo_s else capture.period_s
        self._lines(f"SAMP PERIOD {every_s:g}")
        self._lines(f"CLR {MODE}")
        self._event = _event_of(capture)
        if self._event is not None:
            self._lines(f"SAMP TRG {self._event.trigger}")
        self._settings = self._lines("SAMP")
        self._is_on = True
        self._arm()

    def _arm(self) -> None:
        """Begin a record, or wait with it until the event is ahead."""
        self._reading = None
        line = ARM if self._event is None else f"IF ({self._event.is_ahead}) THEN {ARM}"
        self._is_armed = bool(self._lines(line))  # in one line: no change is lost in between

    def step(self, session: MillSession, scope: Scope, now_s: float) -> None:
        """Poll whether the arrays are full; then read some of their elements.

        A record during which the link was lost is begun anew.
        """
        capture = scope.running
        if capture is None:
            return
        try:
            if self._reading is not None:
                next(self._reading, None)
            elif now_s >= self._poll_s:
                self._poll_s = now_s + POLL_S
                self._poll(scope, capture)
        except LINK_ERRORS:
            self._reading, self._is_armed = None, False
            raise

    def _poll(self, scope: Scope, capture: Capture) -> None:
        if not self._is_armed:
            self._require_own()
            self._arm()
        elif not self._card.read_bit(ARMED):
            self._reading = self._read(scope, capture)

    def _require_own(self) -> None:
        """UserError where the sampler has other settings than those of the scope."""
        if self._lines("SAMP") != self._settings:
            raise UserError("another host has taken the sampler of the card")

    def _require_full(self) -> None:
        """UserError where the arrays do not hold a whole record of the scope."""
        self._require_own()
        index = int(self._card.read(at.P_SAMPLE_ARRAY_INDEX))
        if index < self._room:
            text = f"the sampler of the card has ended at sample {index} of {self._room}"
            raise UserError(f"{text}: did another host clear BIT{ARMED} or an array?")

    def _read(self, scope: Scope, capture: Capture) -> Iterator[None]:
        """Read a record piece by piece, add it to the scope, and arm again unless that was all."""
        self._require_full()
        is_searched = capture.trigger is not None and self._event is None
        count = self._room if is_searched else capture.samples
        block = np.empty((len(capture.channels), count))
        for place, channel in enumerate(capture.channels):
            name = _array(place, channel)
            for first in range(0, count, self._at_once):
                part = range(first, min(count, first + self._at_once))
                values = self._card.read_array(self._program, name, part)
                block[place, part.start : part.stop] = [value_in(channel, v) for v in values]
                yield
        self._require_full()
        if self._event is not None:
            scope.follow(float(not self._event.is_set))
        scope.add(block)
        if capture.trigger is not None:
            scope.break_off()
        if scope.running is capture:
            self._arm()

    def collect(self, scope: Scope) -> None:
        """Records are added once they have been read."""

    def end(self) -> None:
        """Disarm the sampler, unless another host has taken it; its settings stay."""
        if self._is_on:
            with suppress(OpenacrError):  # also of a card that is lost
                self._require_own()
                self._lines(f"CLR {ARMED}")
            self._is_on = False


def _array(place: int, channel: Parameter | Flag) -> str:
    """The array of a channel: LONG for flag words and LONG parameters, else FP32."""
    is_long = isinstance(channel, Flag) or channel.kind is Kind.LONG
    return f"{'LA' if is_long else 'SA'}{place}"


def _event_of(capture: Capture) -> _Event | None:
    """The change that the card can wait for: an edge of a flag, where the sweep begins.

    Not for sweeps that also begin without a trigger (auto).
    """
    trigger = capture.trigger
    if trigger is None or trigger.mode == "auto" or capture.before:
        return None
    channel, is_set = capture.channels[trigger.channel], trigger.slope > 0
    if trigger.slope == EITHER or not isinstance(channel, Flag):
        return None
    states = (0.0, 1.0) if is_set else (1.0, 0.0)
    is_edge = len(trigger.crossings(np.array(states))) > 0
    return _Event(channel.number, is_set) if is_edge else None
