"""The world around a card as a viewer sees it: what there is, and the state it is in."""

from collections.abc import Iterator
from dataclasses import dataclass

from openacr.map.memory import Memory
from openacr.map.rows import motors
from openacr.plant import inputs
from openacr.plant.describe.check import sources
from openacr.plant.describe.counts import position_of
from openacr.plant.describe.links import Link, links_of, subject_of
from openacr.plant.describe.schema import Axis, Switch, World, switches
from openacr.plant.devices.device import Value
from openacr.plant.inputs import InputState
from openacr.plant.world import faults
from openacr.plant.world.attached_devices import Attached, AttachedDevices
from openacr.plant.world.fault_kinds import MachineFault

ONBOARD = range(32)


@dataclass(frozen=True, slots=True)
class Source:
    """An input, and what drives it ("": nothing; it is switched by hand)."""

    flag: int
    what: str
    is_driven: bool


@dataclass(frozen=True, slots=True)
class FaultChoice:
    """A fault that an axis can have, or why it cannot."""

    axis: int
    kind: MachineFault
    why_not: str
    key: str = ""  # of its quantity; "" without one
    unit: str = ""
    range: str = ""


@dataclass(frozen=True, slots=True)
class Fact:
    """A fault that is there now."""

    axis: int
    kind: MachineFault
    value: float


@dataclass(frozen=True, slots=True)
class DeviceState:
    """A device as it is now; signals are those of its last step."""

    commands: dict[str, Value]
    signals: dict[str, Value]


@dataclass(frozen=True, slots=True)
class WorldState:
    """The world at one moment; positions in the units of the axes, in the order of the links."""

    positions: tuple[float, ...]
    inputs: tuple[InputState, ...]  # in the order of `sources`
    faults: tuple[Fact, ...]
    devices: tuple[DeviceState, ...]


class WorldView:
    """The world of one card, for viewers: nothing here changes anything."""

    def __init__(self, memory: Memory, world: World, devices: AttachedDevices) -> None:
        self._memory, self._world, self._devices = memory, world, devices
        self.links: tuple[Link, ...] = links_of(map(subject_of, world.axis))
        self.sources: tuple[Source, ...] = tuple(_sources(world))
        self.choices: tuple[FaultChoice, ...] = tuple(_choices(world))

    def axis(self, number: int) -> Axis:
        """An axis of the world by its number."""
        return next(each for each in self._world.axis if each.number == number)

    def switches(self, number: int) -> list[Switch]:
        """The switches of an axis."""
        return list(switches(self.axis(number)))

    @property
    def devices(self) -> list[Attached]:
        """The devices, in the order of the machine file."""
        return list(self._devices)

    def now(self) -> WorldState:
        """The state at this moment."""
        return WorldState(
            tuple(self._position_u(link.axis) for link in self.links),
            self.inputs(),
            tuple(Fact(*each) for each in faults.active(self._world, self._memory)),
            tuple(DeviceState(each.commands, each.signals) for each in self._devices),
        )

    def inputs(self) -> tuple[InputState, ...]:
        """The inputs at this moment, in the order of `sources`."""
        return tuple(inputs.state(self._memory, each.flag) for each in self.sources)

    def _position_u(self, number: int) -> float:
        count = self._memory.F[motors.position_cnt[number]]
        return position_of(self.axis(number), count)


def _sources(world: World) -> Iterator[Source]:
    """The inputs that the world drives in the order of the file, then those it leaves alone."""
    driven = {number: what for _, number, what in sources(world)}
    for number, what in driven.items():
        yield Source(number, what, True)
    reports = {
        axis.drive.fault_input: f"drive fault of axis {axis.label}"
        for axis in world.axis
        if axis.drive.fault_input is not None
    }
    for number in sorted({*ONBOARD, *reports} - driven.keys()):
        yield Source(number, reports.get(number, ""), False)


def _choices(world: World) -> Iterator[FaultChoice]:
    for axis in world.axis:
        for kind, fault in faults.FAULTS.items():
            why_not = fault.bar(axis)
            if fault.quantity is None or why_not:
                yield FaultChoice(axis.number, kind, why_not)
                continue
            limits = fault.quantity.range_words(fault.highest(axis))
            unit = fault.quantity.unit or axis.units
            yield FaultChoice(axis.number, kind, "", fault.quantity.key, unit, limits)
