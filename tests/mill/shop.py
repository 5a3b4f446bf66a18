"""A milling machine on a virtual card, run with canonical entries written by hand."""

from collections.abc import Iterable, Iterator
from typing import Any

from openacr.client import Card
from openacr.cnc import canonical as c
from openacr.cnc.interpreter.interpreter import Interpreter
from openacr.cnc.interpreter.interpreter import Options as Reading
from openacr.cnc.loading.load import load
from openacr.controller import Controller
from openacr.map.rows import axes as axis_rows
from openacr.mill.card.driver import MachineDriver
from openacr.mill.card.setup import prepare
from openacr.mill.config.settings import Settings
from openacr.mill.run.lifecycle import Options, State
from openacr.mill.run.run_host import RunHost
from openacr.mill.run.runner import Runner
from openacr.sysvar import Store

FILE = "TEST.TXT"
PULSES = 10000.0
STEP_S = 0.005
HOME_REQUIRED, MAX_SPEED = 200_007, 650_000


def src(line: int = 1, text: str = "") -> c.Source:
    return c.Source(FILE, line, text)


def at(x: float = 0.0, y: float = 0.0, z: float = 0.0) -> c.Point:
    return (x, y, z, 0.0, 0.0, 0.0, 0.0, 0.0)


def line(number: int, end: c.Point, feed: float = 600.0, **pace: Any) -> c.Line:
    return c.Line(src(number), end, c.Pace(feed, **pace))


def rapid(number: int, end: c.Point) -> c.Rapid:
    return c.Rapid(src(number), end)


def end(number: int = 99) -> c.End:
    return c.End(src(number), is_by_code=True)


class Shop:
    """A machine with axes X Y Z; nothing has to be homed."""

    def __init__(self, **cells: float) -> None:
        self._set_up(Controller(), cells)

    @classmethod
    def on(cls, controller: Controller, cells: dict[str, float]) -> "Shop":
        """On a machine that is there already."""
        shop = cls.__new__(cls)
        shop._set_up(controller, cells)
        return shop

    def _set_up(self, controller: Controller, cells: dict[str, float]) -> None:
        self.store = Store()
        for axis in range(3):
            self.store.write(HOME_REQUIRED + 1000 * axis, 0)
        self.store.write(MAX_SPEED, 6000.0)
        for name, value in cells.items():
            self.store.write(int(name.removeprefix("P")), value)
        self.controller = controller
        self.card = Card.open(self.controller)
        settings = Settings(self.store)
        depth = prepare(self.card, settings)
        self.card.command("DRIVE ON X Y Z", program=0)
        axes = [axis.index for axis in settings.axes]
        machine = MachineDriver(self.card, axes, settings.master, rounds_corners=True)
        self.said: list[str] = []
        self.runner = Runner(machine, self.store, depth, self.said.append)
        self.path: list[tuple[float, float, float]] = []

    def start(self, *entries: c.Entry, options: Options | None = None) -> None:
        def all_of(_host: RunHost) -> Iterator[c.Entry]:
            yield from entries

        self.runner.run(all_of, options)

    def load(self, text: str, options: Options | None = None) -> None:
        """Start a program written as text."""
        program = load(text, self.store)
        assert program.errors == [], program.errors
        options = options or Options()
        reading = Reading(is_dry=options.is_dry, has_block_ends=True)
        host = self.runner.stream.host
        run = Interpreter(program, self.store, host, options=reading)
        self.runner.run(lambda _host: run.entries(), options)

    def run_text(self, text: str, options: Options | None = None) -> float:
        """Run a program written as text to its end; how long it took on the card."""
        before = self.controller.tick
        self.load(text, options)
        assert self.until(State.IDLE) is State.IDLE
        return (self.controller.tick - before) * self.controller.period_s

    def pass_time(self, seconds: float) -> None:
        """So many seconds of card time, looked at every 5 ms."""
        for _ in range(round(seconds / STEP_S)):
            self.controller.advance(seconds=STEP_S)
            self.runner.step()

    def until(self, *states: State, limit_s: float = 60.0) -> State:
        """Until the run is in one of these states and nothing is left to be done."""
        for _ in range(round(limit_s / STEP_S)):
            if self.runner.state in states and not self._is_ending():
                return self.runner.state
            self.pass_time(STEP_S)
            self.path.append(self.place())
        up = [alarm.text for alarm in self.runner.alarms.active]
        raise AssertionError(f"{self.runner.state.name} {self.runner.reason} {up}")

    def _is_ending(self) -> bool:
        return self.runner.state in (State.IDLE, State.ALARM) and self.runner.is_busy

    def finish(self, *entries: c.Entry, options: Options | None = None) -> float:
        """Run to the end; how long it took on the card."""
        before = self.controller.tick
        self.start(*entries, options=options)
        assert self.until(State.IDLE) is State.IDLE
        return (self.controller.tick - before) * self.controller.period_s

    def place(self) -> tuple[float, float, float]:
        """Where X Y Z are commanded to stand."""
        rows = (axis_rows.current_position[axis] for axis in range(3))
        x, y, z = (self.controller.p[row] / PULSES for row in rows)
        return x, y, z

    def pulses(self) -> tuple[int, ...]:
        rows = (axis_rows.current_position[axis] for axis in range(3))
        return tuple(int(self.controller.p[row]) for row in rows)

    def outputs(self, numbers: Iterable[int]) -> list[bool]:
        return [self.controller.bit[number] for number in numbers]
