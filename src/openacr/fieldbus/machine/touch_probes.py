"""The touch probes of a drive: armed by the captures of the card, read into its rows.

Probe 1 looks for an edge of the drive's input, probe 2 for the marker of its encoder. A drive
latches once until the bit of its function is off: what was latched is taken, then the bit rests
until the drive shows that it has forgotten, so that a capture that is armed at once is served.
"""

from collections.abc import Callable
from dataclasses import dataclass

from openacr.fieldbus.cia402 import objects as of
from openacr.fieldbus.cia402.objects import Entry
from openacr.fieldbus.ethercat.master.mapping import Signal
from openacr.fieldbus.ethercat.master.master import Member
from openacr.kernel.axis.capture_cy import (
    FALLING,
    FIRST_EXTERNAL,
    MARKER,
    MARKER_AND_EXTERNAL,
    OTHER_MARKER,
    capture_signal,
)
from openacr.map.memory import Memory
from openacr.map.rows import axes, bus_motors, motors
from openacr.plant.describe.bus_schema import BusDriveTable

ENABLE, OF_MARKER, RISE, FALL = 0x01, 0x04, 0x10, 0x20  # of the function of a probe
SECOND = 8  # bits by which probe 2 is shifted in function and status


@dataclass(frozen=True, slots=True)
class _Probe:
    shift: int
    source: int
    latches: tuple[Entry, Entry]  # rising, falling
    rows: tuple[tuple[int, ...], tuple[int, ...]]
    reported: int  # bits by which its edges are shifted in the row


INPUT = _Probe(
    0,
    0,
    (of.PROBE_1_RISE, of.PROBE_1_FALL),
    (bus_motors.probe_rise_cnt, bus_motors.probe_fall_cnt),
    0,
)
INDEX = _Probe(
    SECOND,
    OF_MARKER,
    (of.PROBE_2_RISE, of.PROBE_2_FALL),
    (motors.marker_rise_cnt, motors.marker_fall_cnt),
    2,
)


def probes_of(table: BusDriveTable) -> list[_Probe]:
    """The probes that the machine file names."""
    return [probe for probe, on in ((INPUT, table.probe), (INDEX, table.marker)) if on]


def inputs_of(table: BusDriveTable) -> list[Entry]:
    """The objects that its probes need in the inputs of a drive."""
    latches = [entry for probe in probes_of(table) for entry in probe.latches]
    return [of.PROBE_STATUS, *latches] if latches else []


class TouchProbes:
    """The probes of the drive of a motor that captures use."""

    def __init__(self, memory: Memory, motor: int, member: Member, table: BusDriveTable) -> None:
        self._memory, self._motor = memory, motor
        self._probes = probes = probes_of(table)
        out, in_ = member.outputs, member.inputs
        self._function = Signal.of(of.PROBE_FUNCTION, out, member.outputs_at)
        self._status = Signal.of(of.PROBE_STATUS, in_, member.inputs_at)
        self._latches = [
            tuple(Signal.of(entry, in_, member.inputs_at) for entry in probe.latches)
            for probe in probes
        ]
        self._latched = [0] * len(probes)  # as the drive showed it last

    def give(self, image: bytearray) -> None:
        """Arm the probes for the captures that are armed on the card."""
        edges = self._wanted()
        function = 0
        for probe, latched in zip(self._probes, self._latched, strict=True):
            wanted = edges[probe is INDEX]
            if wanted and not latched:
                function |= (ENABLE | probe.source | wanted) << probe.shift
        self._function.put(image, function)

    def _wanted(self) -> tuple[int, int]:
        """The edges that captures of any axis wait for: of the input, of the marker."""
        rows, wanted = self._memory.I, [0, 0]
        for n in range(axes.COUNT):
            mode = rows[axes.capture_mode[n]]
            if mode < 0:
                continue
            signal, encoder = capture_signal(mode), rows[axes.position_index[n]]
            edge = FALL if mode & FALLING else RISE
            if signal == FIRST_EXTERNAL and encoder == self._motor:
                wanted[0] |= edge
            elif signal in (MARKER, MARKER_AND_EXTERNAL) and encoder == self._motor:
                wanted[1] |= edge
            elif signal == OTHER_MARKER and encoder ^ 1 == self._motor:
                wanted[1] |= edge
        return wanted[0], wanted[1]

    def take(self, image: bytes, place_cnt: Callable[[int], float]) -> None:
        """Hand on what was latched; `place_cnt` makes a count of the card of one of the drive."""
        status = self._status.get(image)
        for k, probe in enumerate(self._probes):
            latched = status >> probe.shift + 1 & 3
            fresh, self._latched[k] = latched & ~self._latched[k], latched
            for edge, row in zip((1, 2), probe.rows, strict=True):
                if fresh & edge:
                    signal = self._latches[k][edge - 1]
                    self._memory.F[row[self._motor]] = place_cnt(signal.get(image))
            if fresh:
                reported = bus_motors.reported_edges[self._motor]
                self._memory.I[reported] |= fresh << probe.reported
