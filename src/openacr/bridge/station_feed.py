"""A feed that reads the machine of a panel: what its control thread has made for the screens."""

from concurrent.futures import Future
from itertools import count

from openacr.bridge.feed import STALE_S
from openacr.bridge.moment import MM_PER_INCH, S_PER_MIN, AxisName, Moment
from openacr.mill.config.settings import Settings
from openacr.mill.config.tools import Tool, ToolTable
from openacr.panel.control.engineer.watches import Changed, Wish
from openacr.panel.control.machine.snapshot import Light
from openacr.panel.control.station import Station
from openacr.panel.control.thread import ControlThread
from openacr.sysvar.values import ROTARY

TOOLS_S = 1.0  # between two readings of the tool table
_bridges = count(1)


class StationFeed:
    """The machine of a panel: its own snapshots and facts, which the control thread replaces."""

    def __init__(self, control: ControlThread) -> None:
        self._control, self._station = control, control.station
        self._wish = Wish(-next(_bridges), "bridge")  # browsers count upwards from 1
        self._watched: dict[int, float] = {}
        self._table = ToolTable(self._station.installation.store)
        self._tools: tuple[Tool, ...] | None = None
        self._tools_s, self._asked = -TOOLS_S, Future[None]()
        self._asked.set_result(None)
        self._last_settings = Settings(self._station.installation.store)

    @property
    def axes(self) -> tuple[AxisName, ...]:
        """The axes of the open session: others once the machine is set up again."""
        return tuple(AxisName(axis.name, axis.name in ROTARY) for axis in self._settings.axes)

    @property
    def _settings(self) -> Settings:
        """The settings of the open session, of the last one while none is open."""
        if (session := self._station.link.session) is not None:
            self._last_settings = session.runner.settings
        return self._last_settings

    def start(self, parameters: list[int], rate_hz: float) -> None:
        """Watch the parameters as a browser would."""
        if parameters:
            self._control.call(
                lambda station: station.watches.begin(self._wish, parameters, rate_hz, self._report)
            )

    def _report(self, _wish: Wish, parameters: list[int], changed: Changed) -> None:
        """Take over changed values in the control thread: a new table replaces the old one."""
        self._watched = self._watched | {parameters[place]: value for place, value in changed}

    def newest(self) -> Moment:
        """The newest snapshot with the facts of the station."""
        station = self._station
        run = station.snapshot
        self._ask_tools()
        return Moment(
            lost=self._why_lost(),
            mm_per_unit=1.0 if self._settings.is_metric else MM_PER_INCH,
            commanded=run.commanded,
            actual=run.actual,
            following=run.following,
            speed_ups=run.speed_upm / S_PER_MIN,
            is_moving=bool(run.lights & Light.MOVING),
            run=run,
            facts=station.facts.reported,
            tools=self._tools,
            bus=None if (bus := station.installation.bus) is None else bus.report,
            watched=self._watched,
        )

    def _ask_tools(self) -> None:
        """Have the control thread read the tool table, which it has for the next moments."""
        now_s = self._control.now_s()
        if now_s >= self._tools_s + TOOLS_S and self._asked.done():
            self._tools_s, self._asked = now_s, self._control.call(self._read_tools)

    def _read_tools(self, _station: Station) -> None:
        self._tools = self._table.read()

    def _why_lost(self) -> str:
        station, run = self._station, self._station.snapshot
        if station.link.session is None or not run.number:
            return station.link.lost or "the machine is being opened"
        if station.installation.lacks:  # a card that AcroMill has not set up has no positions
            return station.installation.lacks
        age_s = self._control.now_s() - run.read_s
        return f"the last reading is {age_s:.1f} s old" if age_s > STALE_S else ""

    def write(self, number: int, value: float, *, is_flag: bool) -> "Future[None]":
        """Set a parameter or flag of the card, in the control thread."""

        def carry_out(station: Station) -> None:
            machine = station.link.machine.machine
            if is_flag:
                machine.set_flag(number, bool(value))
            else:
                machine.write(number, value)

        return self._control.call(carry_out)

    def stop(self) -> None:
        """Watch no longer."""
        self._control.call(lambda station: station.watches.end(self._wish))
