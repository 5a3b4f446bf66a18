"""Watchdog: a program on the card that stops the machine when its host is lost.

The host increments a variable of the card. When that has not changed for the link timeout and as
long as it takes between two beats, so that a link may be cut for the link timeout, the card sets
feed hold, stops jogs, and switches spindle, coolant and beam off, repeatedly until an
acknowledgement clears its flag. A planned path leaves no time for that: it holds the feed at the
move from which the path can still come to rest on what has arrived of it. It is plain AcroBASIC in
one of the programs 0 to 7, which have time slices of their own.
"""

from collections.abc import Iterator

from openacr.client import Card
from openacr.client.errors import RefusedError
from openacr.cnc.occupied import HEARTBEAT, HOLD_AT, RAN_SHORT, TRIPPED
from openacr.errors import UserError
from openacr.map import numbers as n
from openacr.map.rows import masters
from openacr.map.words import pf
from openacr.mill.card.actions import DAC_STRIDE, DAC_VALUE
from openacr.mill.card.machine_io import MachineIo
from openacr.mill.card.owner import BEAT_S
from openacr.mill.config.curves import can_plan
from openacr.mill.config.settings import NONE
from openacr.sysvar.tabs import CONTROL

NAME = "REM openacr watchdog"
MEMORY_BYTES = 4096
TEXT_LENGTH = 80
PROGRAM_CELL = CONTROL.watchdog_program
NO_WATCHDOG = (
    f"no watchdog on the card (P{PROGRAM_CELL} is -1): if this host or its link is lost, the"
    " machine completes the moves it has, and spindle, coolant and beam stay on"
)
FLAGS_PER_MASTER, FEED_HOLD_REQUEST = 32, 520
MS_PER_S = 1000
LINE_STEP = 10
PERIOD_S = 0.1  # longest cycle of its program
LOOK_S, QUICK_S = 0.05, 0.005  # between two cycles; of a machine that plans its paths


class Watchdog:
    """The watchdog of one machine on its card."""

    def __init__(self, card: Card, io: MachineIo) -> None:
        self._card = card
        self._io = io
        self._settings = io.settings
        self.program = self._settings.watchdog_program
        if self.program == self._settings.master:
            raise UserError(
                f"P{PROGRAM_CELL} {self.program}: the watchdog cannot be the program of the"
                " master; allowed are 0 to 7, -1 for none"
            )

    def install(self) -> None:
        """Store and start the watchdog; UserError where its program is in use or has no memory."""
        self._require_free_program()
        self._type("HALT", "NEW", "CLEAR")
        try:
            self._store()
        except RefusedError:  # programs are dimensioned, but not this one
            self._dimension()
        self._type("RUN")
        self._card.pause(PERIOD_S)
        if not self.is_running:
            raise UserError(f"the watchdog does not run in program {self.program} of the card")

    def remove(self) -> None:
        """Halt and erase the watchdog."""
        self._type("HALT", "NEW", "CLEAR")

    def rearm(self) -> None:
        """Restart the watchdog after it has stopped the machine or was halted."""
        self._io.machine.set_flag(TRIPPED, False)
        self._card.pause(PERIOD_S)  # it may just be setting its feed hold again
        if not self.is_running:
            self.install()

    @property
    def is_running(self) -> bool:
        """Whether the watchdog program runs."""
        flags = int(self._card.read(pf.word[self.program]))
        return bool(flags & pf.PROGRAM_RUNNING)

    def _require_free_program(self) -> None:
        listed = self._card.command("LIST", program=self.program)
        if listed and NAME not in listed[0]:
            raise UserError(
                f"program {self.program} of the card is in use ({listed[0].strip()}): choose"
                f" another one for the watchdog (P{PROGRAM_CELL}: 0 to 7, -1 for none)"
            )

    def _dimension(self) -> None:
        """Dimension memory for the program and store it again."""
        self._type("NEW")
        try:
            self._card.command("SYS")
            self._card.command(f"DIM PROG{self.program}({MEMORY_BYTES})")
            self._store()
        except RefusedError as refused:
            self._type("NEW")
            raise UserError(
                f"no memory for the watchdog on the card: {refused}; free {MEMORY_BYTES} bytes"
                f" for program {self.program}, or disable it (P{PROGRAM_CELL} = -1)"
            ) from None

    def _store(self) -> None:
        for number, line in enumerate(self.lines(), start=1):
            self._card.command(f"{LINE_STEP * number} {line}", program=self.program)

    def _type(self, *lines: str) -> None:
        for line in lines:
            self._card.command(line, program=self.program)

    # --- the program ------------------------------------------------------------------

    def lines(self) -> list[str]:
        """The program lines, without their numbers 10, 20, 30 ..."""
        timeout_s = self._settings.link_timeout_s
        clock = f"P{n.P_GLOBAL_SYSTEM_CLOCK}"
        begun = masters.move_counter[self._settings.master]
        hold = f"SET {FEED_HOLD_REQUEST + FLAGS_PER_MASTER * self._settings.master}"
        begin = [
            NAME,
            "DIM LV(3)",
            f"DIM $V(1,{TEXT_LENGTH})",
            f"IF (BIT{TRIPPED}) THEN GOTO {{trip}}",
        ]
        first = [f"LV0=P{HEARTBEAT}", f"LV1={clock}"]
        wait = [
            f"DWL {QUICK_S if can_plan(self._settings) else LOOK_S:g}",
            f"IF ((P{HOLD_AT}>0) AND (P{begun}>=P{HOLD_AT})) THEN GOTO {{short}}",
        ]
        look = [
            f"IF (BIT{TRIPPED}) THEN GOTO {{trip}}",
            f"IF (P{HEARTBEAT}<>LV0) THEN GOTO {{first}}",
            f"LV2={clock}-LV1",
            "IF (LV2<0) THEN GOTO {first}",  # the clock has wrapped
            f"IF (LV2<{round((timeout_s + BEAT_S) * MS_PER_S)}) THEN GOTO {{wait}}",
            f"SET {TRIPPED}",
            f'$V0="host silent for {timeout_s:g} s: feed hold, spindle, coolant, beam off"',
        ]
        trip = [hold, *self._stop()]
        trip += [f"DWL {LOOK_S:g}", f"IF (BIT{TRIPPED}) THEN GOTO {{trip}}", "GOTO {first}"]
        short = [hold, f"SET {RAN_SHORT}", "GOTO {look}"]  # until the host takes P98 back
        parts = {"first": first, "wait": wait, "look": look, "trip": trip, "short": short}
        places, lines = {}, begin
        for name, part in parts.items():
            places[name] = LINE_STEP * (len(lines) + 1)
            lines = lines + part
        return [line.format(**places) for line in lines]

    def _stop(self) -> Iterator[str]:
        """Commands for jogs off, then spindle, coolant and beam off."""
        settings = self._settings
        for axis in settings.axes:
            yield f"AXIS{axis.index} JOG OFF"
        for number, is_on in self._io.safe_levels():
            yield f"{'SET' if is_on else 'CLR'} {number}"
        if settings.spindle.dac != NONE:
            yield f"P{DAC_VALUE + DAC_STRIDE * settings.spindle.dac}=0"


def left_text(card: Card, program: int) -> str:
    """The message left by a watchdog that has stopped the machine; empty if there is none."""
    try:
        return " ".join(card.command("?$V0", program=program)).strip()
    except RefusedError:
        return ""
