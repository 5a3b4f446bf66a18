"""Cause of a kill of all motion, kept on the card until the kill is cleared.

The inputs may have changed since: a released emergency stop is still the cause.
Causes of a single axis are not stored: the card keeps their flags.
"""

from openacr.cnc.occupied import KILL_CAUSE
from openacr.mill.card import alarms
from openacr.mill.card.alarms import Kind
from openacr.mill.card.driver import CardState, MachineDriver
from openacr.mill.card.machine_io import MachineIo

KEPT = {kind.code: kind for kind in (alarms.EMERGENCY_STOP, alarms.NO_REST)}


def cause_of(io: MachineIo, sample: CardState) -> Kind | None:
    """The cause that all motion is killed or barred; None if unknown."""
    if io.is_in(sample, io.settings.wiring.emergency_stop):
        return alarms.EMERGENCY_STOP
    return KEPT.get(int(io.machine.read(KILL_CAUSE))) if sample.is_killed else None


class Killed:
    """Classifies a kill that this program has not requested."""

    def __init__(self, machine: MachineDriver) -> None:
        self._machine = machine
        self._found: Kind | None = None  # None before the first poll

    def kind(self, sample: CardState) -> Kind:
        """The alarm of a kill: its stored cause if present at the first poll, else alarm 14."""
        if self._found is None:
            code = int(self._machine.read(KILL_CAUSE))
            self._found = KEPT.get(code, alarms.MOVES_KILLED)
            if not sample.is_killed and code:
                self.forget()
        return self._found

    def note(self, kind: Kind) -> None:
        """Store the cause of a kill requested here."""
        if kind in KEPT.values():
            self._machine.write(KILL_CAUSE, kind.code)

    def forget(self) -> None:
        """Clear the stored cause: the kill was cleared, here or by another host."""
        self._machine.write(KILL_CAUSE, alarms.NO_ALARM)
        self._found = alarms.MOVES_KILLED
