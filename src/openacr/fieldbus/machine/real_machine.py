"""The bus of a machine at work: once a cycle all signals are exchanged with its devices.

What goes wrong, and what follows:

| seen | reaction |
|---|---|
| more than `lost_frames` frames in a row lost, damaged or with a wrong working counter | all stop |
| no exchange for `late_s` | all stop |
| a device leaves OP | all stop |
| the servo period is changed | all stop |
| a drive reports a fault, leaves operation, jumps, operates in another mode | its axis stops |

*Stop*: all motion of the axis is killed, Drive Fault is set, the drive is asked for a quick stop
and is off on the card. DRIVE RES resets it; after a stop of all it brings the bus up again,
a part in each cycle.
"""

import logging

from openacr.fieldbus.ethercat.master.master import Member
from openacr.fieldbus.ethercat.master.port import BusError, Link
from openacr.fieldbus.machine.axis_drive import AxisDrive
from openacr.fieldbus.machine.bringing_up import Brought, bring_up
from openacr.fieldbus.machine.in_parts import InParts
from openacr.fieldbus.machine.report import BusReport, Counters, devices_of, note_state
from openacr.fieldbus.machine.terminal import RealTerminal
from openacr.motion.card import Card
from openacr.plant.describe.bus_schema import Bus
from openacr.plant.describe.schema import World

log = logging.getLogger(__name__)
SHARE = 0.25  # of a cycle, for bringing the bus up again beside the card
LOOK_S = 0.05  # a device is asked for its state so often, one after the other
LATE = 1.5  # cycles between two exchanges, of a late one
LONGEST_S = 60.0  # that it takes


class RealMachine:
    """The drives and terminals of a machine; `attend` once a cycle, `close` at the end."""

    def __init__(self, card: Card, world: World, link: Link) -> None:
        self._card, self._world, self._link = card, world, link
        self._bus = world.bus or Bus()
        self._bad = 0  # exchanges in a row
        self._alarm = ""
        self.may_enable = False
        self.counters: Counters = _none()
        self._looked_s = link.now_s()
        self._next_device = 0
        self._period_s = card.clock.period_s
        brought = bring_up(link, world, self._period_s)
        self._master = brought.master
        self._states = devices_of(self._master)
        self.drives = [
            AxisDrive(card, axis, axis.bus, brought.drives[axis.number])
            for axis in world.axis
            if axis.bus is not None
        ]
        self._terminals = self._made_terminals(brought.terminals)
        self._latest_s: float | None = None
        self._revival: InParts[Brought] | None = None  # after a stop of all, asked by DRIVE RES
        self._revival_s = 0.0

    def enable(self) -> None:
        """Allow drives to be enabled, by DRIVE ON; before it the bus is only read."""
        self.may_enable = True
        for drive in self.drives:
            drive.may_enable = True

    @property
    def alarm(self) -> str:
        """What has stopped all drives, until it is reset."""
        return self._alarm

    @property
    def cycles(self) -> int:
        """Frames of the exchange that were sent."""
        return self.counters["sent"]

    @property
    def bad_cycles(self) -> int:
        """Those that were lost, or came back with a wrong working counter."""
        return self.counters["lost"] + self.counters["wrong"]

    def reset_counters(self) -> None:
        """Let the counters begin at 0."""
        self.counters = _none()

    def report(self) -> BusReport:
        """The state of the bus, its devices and drives."""
        is_heard = not self._bad and self._latest_s is not None
        return {
            "interface": self._link.name,
            "is_real": self.may_enable,
            "is_coming_up": self._revival is not None,
            "alarm": self._alarm,
            "cycle_s": self._bus.cycle * self._period_s,
            "counters": self.counters.copy(),
            "devices": [each.copy() for each in self._states],
            "drives": [
                drive.report(self._master.image, is_heard=is_heard) for drive in self.drives
            ],
            "loop": None,
        }

    def attend(self, tick: int) -> int:
        """Exchange the signals of a tick; the next tick to be called in."""
        now_s = self._link.now_s()
        passed_s = 0.0 if self._latest_s is None else now_s - self._latest_s
        if passed_s > self._bus.late_s:
            self._stop(f"no exchange for {passed_s:.3g} s (late_s = {self._bus.late_s:g})")
        if self._card.clock.period_s != self._period_s:
            self._stop("the servo period was changed: the cycle of the bus is that of its start")
        if self._revival is not None:
            self._revive(self._revival)
            return tick + self._bus.cycle
        for drive in self.drives:
            drive.give(self._master.image, now_s, self._bus.enable_s)
        for terminal in self._terminals:
            terminal.give(self._master.image)
        self._exchange(now_s)
        if now_s - self._looked_s >= LOOK_S:
            self._looked_s = now_s
            self._look()
        if self._alarm and any(drive.is_resetting for drive in self.drives):
            world, period_s = self._world, self._card.clock.period_s
            self._latest_s, self._period_s = None, period_s
            self._revival = InParts(self._link, lambda link: bring_up(link, world, period_s))
            self._revival_s = now_s
        return tick + self._bus.cycle

    def close(self) -> None:
        """Bring all devices to INIT: drives are off, outputs rest."""
        if self._revival is not None:
            self._revival.end()
        self._master.shut_down()

    def _exchange(self, now_s: float) -> None:
        self.counters["sent"] += 1
        cycle_s = self._bus.cycle * self._period_s
        if self._latest_s is not None and now_s - self._latest_s > LATE * cycle_s:
            self.counters["late"] += 1
        before_s = now_s if self._latest_s is None else self._latest_s
        back = self._master.exchange()
        passed_s = self._link.now_s() - before_s  # at most: a frame may wait on its way
        if back is None or not back.is_whole:
            self._bad += 1
            self.counters["lost" if back is None else "wrong"] += 1
            if self._bad > self._bus.lost_frames:
                what = "no frame comes back" if back is None else "the working counter is wrong"
                self._stop(f"{what}, {self._bad} times in a row")
            return
        self._bad = 0
        self._latest_s = now_s
        if not back.are_operating:
            self._stop("a device has left OP")
        for drive in self.drives:
            # One travels for a cycle between two frames, however soon one follows a late one.
            drive.take(back.image, now_s, max(passed_s, cycle_s))
        for terminal in self._terminals:
            terminal.take(back.image)

    def _look(self) -> None:
        """Ask the next device for its state."""
        self._next_device = (self._next_device + 1) % len(self._states)
        device = self._master.devices[self._next_device]
        note_state(self._states[self._next_device], device.state_now())

    def _stop(self, text: str) -> None:
        if not self._alarm:
            log.error("the bus %s: %s; all its drives are stopped", self._link.name, text)
            self._alarm = text
        for drive in self.drives:
            drive.fail(self._alarm)

    def _revive(self, revival: InParts[Brought]) -> None:
        """Go on bringing the bus up again; what cannot be brought up stays stopped."""
        for drive in self.drives:
            drive.bar("the bus is being brought up")
        try:
            if not revival.advance(SHARE * self._bus.cycle * self._period_s):
                if self._link.now_s() - self._revival_s < LONGEST_S:
                    return
                revival.end()
            brought = revival.result()
        except BusError as failure:
            self._revival = None
            log.error("the bus %s stays stopped: %s", self._link.name, failure)
            self._alarm = str(failure)  # the newest cause
            self._stop(self._alarm)
            return
        self._revival = None
        self._master = brought.master
        self._master.port.link = self._link  # from now on in one part
        self._states, self._next_device = devices_of(self._master), 0
        for drive in self.drives:
            drive.connect(brought.drives[drive.axis.number])
            drive.alarm = ""
        self._terminals = self._made_terminals(brought.terminals)
        self._alarm, self._bad, self._latest_s = "", 0, None

    def _made_terminals(self, members: list[Member]) -> list[RealTerminal]:
        memory = self._card.memory
        return [
            RealTerminal(memory, table, member, self._world.card.dac_bits)
            for table, member in zip(self._bus.terminal, members, strict=True)
        ]


def _none() -> Counters:
    return {"sent": 0, "lost": 0, "wrong": 0, "late": 0}
