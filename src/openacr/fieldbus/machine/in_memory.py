"""The bus of a machine in memory: emulated devices for those of its file, in the time of the card.

The file is read as for real devices, except that the emulated ones are in a row in the order of
the positions, count as the encoders of the file do, and are who they have to be.
"""

from collections.abc import Callable

from msgspec.structs import replace

from openacr.fieldbus.ethercat.emulated.drive import Drive
from openacr.fieldbus.ethercat.emulated.motor import Motor, Plant
from openacr.fieldbus.ethercat.emulated.segment import Segment
from openacr.fieldbus.ethercat.emulated.slave import Slave
from openacr.fieldbus.ethercat.emulated.terminals import Analog, Digital
from openacr.plant.describe.bus_schema import Bus, BusDriveTable, CyclicMode, Direction, Terminal
from openacr.plant.describe.schema import Axis, World

EMULATED = "emulated"  # its name in the place of an interface
FRAME_NS = 1000
_UNCHECKED = {
    "alias": None, "serial": None, "vendor": None, "product": None, "revision": None,
}  # fmt: skip


def with_positions(world: World) -> World:
    """The machine with the places and scales that its emulated devices have."""
    bus = world.bus or Bus()
    tables = [axis.bus for axis in world.axis if axis.bus is not None]
    places = sorted((*tables, *bus.terminal), key=lambda one: one.position or 0)
    at = {id(table): number for number, table in enumerate(places)}
    return replace(
        world,
        axis=tuple(
            replace(axis, bus=_counting(axis, axis.bus, at[id(axis.bus)])) if axis.bus else axis
            for axis in world.axis
        ),
        bus=replace(
            bus,
            terminal=tuple(
                replace(one, position=at[id(one)], **_UNCHECKED) for one in bus.terminal
            ),
        ),
    )


def segment_of(world: World) -> Segment:
    """The devices of a machine `with_positions`; UserError for a motor that a bus cannot have."""
    plant = Plant(world)
    found: dict[int, Slave] = {}
    for axis in world.axis:
        if axis.bus is not None and axis.bus.position is not None:
            found[axis.bus.position] = Drive(Motor(plant, axis), axis.label)
    for one in world.bus.terminal if world.bus else ():
        found[one.position or 0] = _terminal(one)
    return Segment([found[place] for place in sorted(found)], plant)


class EmulatedLink:
    """Carries frames to a segment; its time is that of the card, `card_ns`."""

    name = EMULATED

    def __init__(self, segment: Segment, card_ns: Callable[[], int]) -> None:
        self.segment = segment
        self._card_ns = card_ns
        self._own_ns = 0  # that frames and waits have taken

    def exchange(self, frame: bytes) -> bytes | None:
        """The frame as it comes back."""
        self._own_ns += FRAME_NS
        return self.segment.process(frame, self._now_ns()) or None

    def now_s(self) -> float:
        """Seconds of the segment."""
        return self._now_ns() * 1e-9

    def pause(self, seconds: float) -> None:
        """Let time pass."""
        self._own_ns += round(seconds * 1e9)

    def close(self) -> None:
        """There is nothing to close."""

    def _now_ns(self) -> int:
        return self._card_ns() + self._own_ns


def _counting(axis: Axis, table: BusDriveTable, position: int) -> BusDriveTable:
    """The table of a drive that counts as the encoder of the file does."""
    per_volt = table.per_volt
    if per_volt is not None and table.mode is CyclicMode.CSV:
        per_volt *= axis.counts / (table.counts_per_rev or axis.counts)
    return replace(
        table,
        position=position,
        counts_per_rev=None,
        direction=Direction.UP,
        per_volt=per_volt,
        **_UNCHECKED,
    )


def _terminal(one: Terminal) -> Slave:
    name = one.name or EMULATED
    if one.adcs or one.dacs:
        return Analog(one.adcs, one.dacs, name)
    return Digital(one.inputs, one.outputs, name)
