"""A card with drives on an emulated bus in the same process; time is the card's own."""

from collections.abc import Callable

from openacr.controller import Controller
from openacr.fieldbus.ethercat.emulated.build import segment_of
from openacr.fieldbus.ethercat.emulated.drive import Drive
from openacr.fieldbus.ethercat.emulated.segment import Segment
from openacr.fieldbus.machine.real_machine import RealMachine
from openacr.map.rows import axes
from openacr.map.words import af4
from openacr.plant.describe.load import parse_world
from openacr.plant.describe.real_world import real_world

PERIOD_NS = 500_000


class SegmentLink:
    """Carries frames to a segment; time passes where the card or the master lets it."""

    name = "emulated"

    def __init__(self, segment: Segment) -> None:
        self.segment = segment
        self.now_ns = 1_000_000
        self.frames = 0
        self.frame_ns = 1000  # a frame takes
        self.pass_on: Callable[[bytes], bytes | None] | None = None  # faults of the wire

    def exchange(self, frame: bytes) -> bytes | None:
        """The frame as it comes back."""
        self.frames += 1
        self.now_ns += self.frame_ns
        back = self.segment.process(frame, self.now_ns) or None
        return back if back is None or self.pass_on is None else self.pass_on(back)

    def now_s(self) -> float:
        """Seconds of the segment."""
        return self.now_ns * 1e-9

    def pause(self, seconds: float) -> None:
        """Let time pass."""
        self.now_ns += round(seconds * 1e9)


class _InTime:
    """Real devices for which a tick of the card is a period of the segment."""

    def __init__(self, machine: RealMachine, link: SegmentLink) -> None:
        self.machine, self.link = machine, link
        self._tick = 0

    def attend(self, tick: int) -> int:
        passed = tick - self._tick if tick > self._tick else 1
        self._tick = tick
        self.link.now_ns += passed * PERIOD_NS
        return self.machine.attend(tick)


class OnBus:
    """A card, its machine and the segment, with programs typed at P00."""

    def __init__(
        self, text: str, *, is_real: bool = True, digital: int = 0, analog: int = 0
    ) -> None:
        model = parse_world(text)
        self.segment = segment_of(model, digital, analog)
        self.link = SegmentLink(self.segment)
        world = real_world(model)
        self.card = Controller(world.card.board, world=world)
        self.machine = RealMachine(self.card.card, world, self.link)
        if is_real:
            self.machine.enable()
        self.card.devices.join(_InTime(self.machine, self.link))
        numbers = [axis.number for axis in world.axis]
        attached = [f"ATTACH AXIS{n} ENC{n} DAC{n} ENC{n}" for n in numbers]
        slaves = [f'ATTACH SLAVE{k} AXIS{n} "{"XYZA"[k]}"' for k, n in enumerate(numbers)]
        scale = [f"MULT {'XYZA'[k]}4" for k in range(len(numbers))]
        for line in ("SYS", *attached, "PROG0", "ATTACH MASTER0", *slaves, *scale):
            self.send(line)
        self.card.advance(5)

    def send(self, *lines: str) -> str:
        """Type lines; what the card has answered to them."""
        return "".join(self.card.send(line + "\r") for line in lines)

    def drive(self, number: int = 0) -> Drive:
        """The emulated drive at a position."""
        drive = self.segment.slaves[number]
        assert isinstance(drive, Drive)
        return drive

    def position(self, n: int = 0) -> int:
        """Actual position of an axis [pulses]."""
        return self.card.memory.I[axes.actual_position[n]]

    def setpoint(self, n: int = 0) -> int:
        """Secondary setpoint of an axis."""
        return self.card.memory.I[axes.secondary_setpoint[n]]

    def is_enabled(self, n: int = 0) -> bool:
        """Whether Drive Enabled is set."""
        return bool(self.card.memory.I[af4.word[n]] & af4.DRIVE_ENABLED)

    def switch_on(self, n: int = 0) -> None:
        """DRIVE ON, and wait until it is."""
        self.send(f"DRIVE ON {'XYZA'[n]}")
        for _ in range(400):
            if self.is_enabled(n):
                return
            self.card.advance(1)
        raise AssertionError(f"axis {n} is not enabled: {self.machine.drives[n].alarm}")
