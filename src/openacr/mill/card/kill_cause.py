"""Why all motion was killed, kept on the card for the next program until the kill is taken back.

The inputs may have changed since: an emergency stop that was released is still what killed.
Causes of a single axis need no memory, the card keeps their flags.
"""

from openacr.cnc.occupied import KILL_CAUSE
from openacr.mill.card import alarms
from openacr.mill.card.alarms import Kind
from openacr.mill.card.driver import CardState, MachineDriver
from openacr.mill.card.machine_io import MachineIo

KEPT = {kind.code: kind for kind in (alarms.EMERGENCY_STOP, alarms.NO_REST)}


def cause_of(io: MachineIo, sample: CardState) -> Kind | None:
    """Why all motion is killed, or may not begin, to any program; None if it is not known."""
    if io.is_in(sample, io.settings.wiring.emergency_stop):
        return alarms.EMERGENCY_STOP
    return KEPT.get(int(io.machine.read(KILL_CAUSE))) if sample.is_killed else None


class Killed:
    """What a kill is called that this program has not made."""

    def __init__(self, machine: MachineDriver) -> None:
        self._machine = machine
        self._found: Kind | None = None  # None before the first look

    def kind(self, sample: CardState) -> Kind:
        """The cause of a kill that was there at the first look; any later one is another's."""
        if self._found is None:
            code = int(self._machine.read(KILL_CAUSE))
            self._found = KEPT.get(code, alarms.MOVES_KILLED)
            if not sample.is_killed and code:
                self.forget()
        return self._found

    def note(self, kind: Kind) -> None:
        """Keep why all motion was killed here."""
        if kind in KEPT.values():
            self._machine.write(KILL_CAUSE, kind.code)

    def forget(self) -> None:
        """The kill is taken back, or was by others."""
        self._machine.write(KILL_CAUSE, alarms.NO_ALARM)
        self._found = alarms.MOVES_KILLED
