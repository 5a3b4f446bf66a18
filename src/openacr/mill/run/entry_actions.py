"""Actions of canonical entries other than moves, executed at rest and in order."""

from collections.abc import Callable
from contextlib import ExitStack
from functools import singledispatchmethod
from math import inf
from typing import TYPE_CHECKING

from openacr.client.errors import RefusedError
from openacr.cnc import canonical as c
from openacr.cnc.state.hosts import Switched
from openacr.errors import MapError
from openacr.map.rows import axes as axis_rows
from openacr.mill.card import alarms
from openacr.mill.card.actions import Coolant, Spindle, Steps, ToolChanger, Until, pause
from openacr.mill.card.alarms import AlarmError
from openacr.mill.card.machine_io import MachineIo
from openacr.mill.config.settings import NONE, Store
from openacr.mill.run.feeding import Fault, Halt, InPosition
from openacr.sysvar.tabs import CELLS

if TYPE_CHECKING:
    from openacr.mill.card.driver import CardState

SETTLED_S = 0.5  # longest time axes take to come to rest after their targets
PULSES_OFF = 2.0  # what the check of a reference point allows


class EntryActions:
    """Executes entries: spindle, coolant, tools, outputs and waits of one machine."""

    def __init__(self, io: MachineIo, store: Store, say: Callable[[str], None]) -> None:
        self._io = io
        self._store = store
        self.say = say
        self.spindle = Spindle(io)
        self.coolant = Coolant(io)
        self.changer = ToolChanger(io, self.spindle)
        self.is_tapping = False  # a tap may be in the hole

    def off(self) -> None:
        """Switch spindle, coolant and beam off, each even if another fails."""
        burning = self._io.settings.burning
        with ExitStack() as each:  # in reverse order
            each.callback(self.spindle.switch_off)
            each.callback(self.coolant.set, mist=False, flood=False)
            for beam in (burning.plasma, burning.under_burn):
                each.callback(self._io.output, beam, False)

    def switched(self) -> Switched:
        """Spindle and coolant as they are now."""
        spindle, coolant = self.spindle, self.coolant
        return Switched(c.Spin(spindle.state), spindle.rpm, coolant.has_mist, coolant.has_flood)

    @singledispatchmethod
    def steps(self, halt: Halt) -> Steps:
        """The steps of one entry; none for entries that only end or hold a program."""
        yield from ()

    @steps.register
    def _(self, halt: Fault) -> Steps:
        raise AlarmError(halt.kind, halt.detail)
        yield

    @steps.register
    def _(self, halt: InPosition) -> Steps:
        limit_s = self._io.settings.speeds.in_position_s or inf
        yield Until(
            "in position", lambda sample: sample.is_in_position, limit_s, alarms.NOT_IN_POSITION
        )

    @steps.register
    def _(self, entry: c.Dwell) -> Steps:
        yield pause(entry.seconds, f"dwell {entry.seconds:g} s", is_dwell=True)

    @steps.register
    def _(self, entry: c.Spindle) -> Steps:
        if entry.spin is c.Spin.OFF:
            self.spindle.rpm = entry.rpm
            yield from self.spindle.stop() if entry.is_awaited else ()
        elif entry.is_awaited:
            yield from self.spindle.start(entry.spin.value, entry.rpm)
        else:
            self.spindle.set_speed(entry.rpm)

    @steps.register
    def _(self, entry: c.Orient) -> Steps:
        if entry.is_on:
            yield from self.spindle.orient()
        else:
            self.spindle.release()

    @steps.register
    def _(self, entry: c.Tapping) -> Steps:
        self.is_tapping = entry.is_on
        yield from ()

    @steps.register
    def _(self, entry: c.Coolant) -> Steps:
        self.coolant.set(entry.mist, entry.flood)
        yield from ()

    @steps.register
    def _(self, entry: c.Output) -> Steps:
        self._io.output(entry.number, entry.is_on)
        yield from ()

    @steps.register
    def _(self, entry: c.SetBit) -> Steps:
        self._io.machine.set_flag(entry.bit, entry.is_on)
        yield from ()

    @steps.register
    def _(self, entry: c.WaitBit) -> Steps:
        card, was_other = self._io.machine.card, not entry.is_edge

        def is_met(_sample: "CardState") -> bool:
            nonlocal was_other
            is_so = card.read_bit(entry.bit) == entry.is_on
            was_other |= not is_so
            return is_so and was_other

        yield Until(entry.reason, is_met, entry.limit_s)

    @steps.register
    def _(self, entry: c.Tool) -> Steps:
        old = int(self._store.read(CELLS.tool_in_spindle))
        if entry.number != old:
            yield from self.changer.change(entry.number, old)
            self._store.write(CELLS.tool_in_spindle, entry.number)

    @steps.register
    def _(self, entry: c.Transfer) -> Steps:
        try:
            self._io.machine.write(entry.parameter, entry.value)
        except (MapError, RefusedError):
            name, line = f"P{entry.parameter}", entry.source.line
            detail = f"line {line}: T {name}: the card has no {name}; DIM P creates it"
            raise AlarmError(alarms.PROGRAM_ERROR, detail) from None
        yield from ()

    @steps.register
    def _(self, entry: c.SetCell) -> Steps:
        self._store.write(entry.parameter, entry.value)
        yield from ()

    @steps.register
    def _(self, entry: c.Say) -> Steps:
        self.say(entry.text)
        yield from ()

    @steps.register
    def _(self, entry: c.Confirm) -> Steps:
        if entry.check is c.Check.REFERENCE_INPUT:
            yield from self._reference_input()
        else:
            yield from self._at_reference(entry)

    def _reference_input(self) -> Steps:
        """Check the reference switch (G27); the output stays on if the switch does not respond."""
        wiring, io = self._io.settings.wiring, self._io
        io.output(wiring.g27_output, True)

        def is_on(sample: "CardState") -> bool:
            return io.is_in(sample, wiring.g27_input)

        yield Until("reference input", is_on, wiring.reference_s, alarms.NOT_CONFIRMED)
        io.output(wiring.g27_output, False)

    def _at_reference(self, entry: c.Confirm) -> Steps:
        """Check that the axes have settled at the reference point (G28, G30)."""
        yield Until("reference point", lambda _sample: not self._missed(entry), SETTLED_S)
        missed, wiring = self._missed(entry), self._io.settings.wiring
        if missed:
            number = wiring.g28_error if wiring.g28_error != NONE else wiring.g27_output
            self._io.output(number, True)
            raise AlarmError(alarms.POINT_MISSED, missed)

    def _missed(self, entry: c.Confirm) -> str:
        """The first axis off its reference point and its deviation, as text; empty if none."""
        machine = self._io.machine
        counts = dict(
            zip(machine.axes, machine.axis_values(axis_rows.actual_position), strict=True)
        )
        for index in entry.axes:
            axis = self._io.settings.axis(index)
            off_u = abs(counts[index] / axis.pulses_per_unit - entry.point[index])
            if off_u > max(axis.in_position_u, PULSES_OFF / axis.pulses_per_unit):
                return f"axis {axis.name} off by {off_u:.6g}"
        return ""
