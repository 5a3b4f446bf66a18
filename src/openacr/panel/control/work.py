"""The coordinate system that positions are shown in: that of the program, else of MDI."""

from openacr.cnc.canonical import Point
from openacr.cnc.interpreter.interpreter import Interpreter
from openacr.mill.session import MillSession
from openacr.mill.zeroing import reader
from openacr.sysvar.tabs import CELLS

# What the shift between program and machine is made of.
FROM = range(CELLS.floating_zero_active, CELLS.work_system_in_use + 1)
LENGTHS = (CELLS.current_h_length, CELLS.current_h_wear)


class WorkSystem:
    """Program coordinates of machine positions."""

    def __init__(self, session: MillSession) -> None:
        self._session = session
        self._idle = reader(session)
        self._parts: tuple[float, ...] = ()

    @property
    def run(self) -> Interpreter:
        """The interpreter whose modal state and offsets count."""
        session = self._session
        is_typed = session.runner.options.is_mdi
        if session.reading is not None and (session.runner.is_busy or is_typed):
            return session.reading
        return self._idle

    def program(self, machine: Point) -> Point:
        """A machine position in program coordinates."""
        run = self.run
        if not self._session.runner.is_busy:
            self._follow(run)
        coordinates = run.path.coordinates
        return coordinates.backward(coordinates.from_machine(machine))

    def _follow(self, run: Interpreter) -> None:
        """Take over offsets that were stored; a program under way keeps those it has read."""
        read = run.cells.read
        parts = (*map(read, FROM), *map(read, LENGTHS), float(run.modal.work), float(id(run)))
        if parts != self._parts:
            self._parts = parts
            run.path.coordinates.refresh(run.modal)
