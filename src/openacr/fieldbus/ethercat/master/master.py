"""All devices of a segment with one process image: brought up, exchanged, shut down.

The image holds the outputs of all devices, then their inputs, each device from a whole byte on. One
LRW datagram exchanges it, a BRD in the same frame tells whether a device has left OP.
"""

from dataclasses import dataclass, field

from openacr.fieldbus.ethercat.master import clocks
from openacr.fieldbus.ethercat.master.device import STATE_S, Device
from openacr.fieldbus.ethercat.master.mapping import Layout
from openacr.fieldbus.ethercat.master.port import BusError, Port
from openacr.fieldbus.ethercat.wire import managers
from openacr.fieldbus.ethercat.wire.frames import (
    LONGEST_DATA,
    Command,
    Datagram,
    by_logical,
    by_station,
)
from openacr.fieldbus.ethercat.wire.managers import Fmmu, SyncManager, SyncUse
from openacr.fieldbus.ethercat.wire.registers import ERROR, STATE_MASK, Register, State

OTHERS = 60  # bytes of a frame beside the image


@dataclass(slots=True)
class Member:
    """A device that takes part in the exchange: its layouts, and where they are in the image."""

    device: Device
    outputs: Layout = field(default_factory=Layout)
    inputs: Layout = field(default_factory=Layout)
    outputs_at: int = 0
    inputs_at: int = 0

    @property
    def counter(self) -> int:
        """What it adds to the working counter of the exchange."""
        return 2 * (self.outputs.size > 0) + (self.inputs.size > 0)


@dataclass(frozen=True, slots=True)
class Exchanged:
    """What came back: the image, whether all devices took part, whether all are in OP."""

    image: bytes
    is_whole: bool
    are_operating: bool


class Master:
    """The devices of a bus; `members` take part in the exchange, the others stay in PREOP."""

    def __init__(self, port: Port, devices: list[Device]) -> None:
        self.port = port
        self.devices = devices
        self.members: list[Member] = []
        self.image = bytearray()
        self.counter = 0  # the working counter of a whole exchange
        self._reference: int | None = None  # station of the clock all others follow

    def to_preop(self) -> None:
        """Bring all devices into PREOP with their mailboxes, whatever they have done before."""
        for device in self.devices:
            device.reach(State.INIT)
            for number in range(2):
                self._manager(device, number, SyncManager(0, 0, 0, activate=0))
            boxes = device.description.mailboxes
            if boxes.out_size:
                out, in_ = managers.MAILBOX_OUT_CONTROL, managers.MAILBOX_IN_CONTROL
                self._manager(device, 0, SyncManager(boxes.out_start, boxes.out_size, out))
                self._manager(device, 1, SyncManager(boxes.in_start, boxes.in_size, in_))
            device.reach(State.PREOP)

    def join(self, member: Member) -> None:
        """Let a device take part in the exchange; before `to_safeop`."""
        self.members.append(member)

    def to_safeop(self, cycle_s: float, *, with_clocks: bool) -> None:
        """Lay out the image and bring the members into SAFEOP: inputs are read, outputs rest."""
        self._lay_out()
        for member in self.members:
            self._map(member)
        if with_clocks:
            self._needs_line()
            self._reference = clocks.synchronize(self.port, self.members_devices, cycle_s)
        for member in self.members:
            member.device.reach(State.SAFEOP)

    def _needs_line(self) -> None:
        """Delays are measured in a line only."""
        for device in self.devices:
            if not device.is_in_line and device.place is not None:
                raise BusError(
                    f"{device.label} is in a branch, at port {device.place.port} of device"
                    f" {device.place.device}: clocks are set up in a line only; say dc = false"
                    " in [bus]"
                )

    @property
    def members_devices(self) -> list[Device]:
        """The devices that take part."""
        return [member.device for member in self.members]

    def to_op(self) -> None:
        """Bring the members into OP; the image as it is goes out meanwhile."""
        for member in self.members:
            member.device.request(State.OP)
        deadline_s = self.port.link.now_s() + STATE_S
        while True:
            back = self.exchange()
            if back is not None and back.are_operating:
                return
            for member in self.members:
                state, code = member.device.state()
                if code or (state is not State.OP and self.port.link.now_s() > deadline_s):
                    member.device.reach(State.OP)  # raises with the reason
            self.port.link.pause(0.001)

    def exchange(self) -> Exchanged | None:
        """Send the outputs of `image`, bring the inputs; None if the frame is lost."""
        back = self.port.once(self.datagrams())
        if back is None:
            return None
        status = int.from_bytes(back[1].data, "little")
        are_operating = not status & self.forbidden and bool(status & State.OP)
        return Exchanged(back[0].data, back[0].counter == self.counter, are_operating)

    def datagrams(self) -> list[Datagram]:
        """The cyclic frame: the image, the joint state of all devices, the clock if any."""
        found = [
            by_logical(Command.LRW, 0, bytes(self.image)),
            by_station(Command.BRD, 0, Register.AL_STATUS, b"\0\0"),
        ]
        if self._reference is not None:
            found.append(_clock(self._reference))
        return found

    @property
    def forbidden(self) -> int:
        """Bits of the joint state that say that a member is not in OP."""
        only_op = State.OP if len(self.members) == len(self.devices) else State.OP | State.PREOP
        return (STATE_MASK | ERROR) & ~only_op

    def shut_down(self) -> None:
        """Bring all devices back to INIT; those that do not answer are left."""
        for device in self.devices:
            try:
                device.request(State.INIT)
            except BusError:
                continue

    def _lay_out(self) -> None:
        at = 0
        for member in self.members:
            member.outputs_at, at = at, at + member.outputs.size
        for member in self.members:
            member.inputs_at, at = at, at + member.inputs.size
        if not 0 < at <= LONGEST_DATA - OTHERS:
            most = LONGEST_DATA - OTHERS
            raise BusError(
                f"the process data of all devices has {at} bytes: 1 to {most} are possible"
            )
        self.image = bytearray(at)
        self.counter = sum(member.counter for member in self.members)

    def _map(self, member: Member) -> None:
        """Set the sync managers and FMMUs of the process data of a device."""
        device = member.device
        sides = (
            (SyncUse.OUTPUTS, member.outputs, member.outputs_at, managers.WRITES),
            (SyncUse.INPUTS, member.inputs, member.inputs_at, managers.READS),
        )
        for number, (use, layout, at, kind) in enumerate(sides):
            sync = device.description.sync_of(use)
            fmmu = Register.FMMU + number * managers.FMMU_SIZE
            if not layout.size or sync is None:
                self.port.write(device.station, fmmu, bytes(managers.FMMU_SIZE))
                continue
            usual = device.description.sync[sync]
            self._manager(device, sync, SyncManager(usual.start, layout.size, usual.control))
            row = Fmmu(at, layout.size, usual.start, kind)
            self.port.write(device.station, fmmu, row.pack())

    def _manager(self, device: Device, number: int, manager: SyncManager) -> None:
        place = Register.SYNC + number * managers.SYNC_SIZE
        self.port.write(device.station, place, manager.pack())


def _clock(station: int) -> Datagram:
    return by_station(Command.FRMW, station, Register.SYSTEM_TIME, bytes(8))
