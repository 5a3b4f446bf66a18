"""A small master in the process of the test: it has an emulated segment on the other end."""

from dataclasses import dataclass, field
from struct import Struct

from openacr.fieldbus.ethercat.emulated.drive import CSP, Drive
from openacr.fieldbus.ethercat.emulated.segment import Segment
from openacr.fieldbus.ethercat.wire import coe, frames, mailbox, sdo_info
from openacr.fieldbus.ethercat.wire.frames import Command, Datagram
from openacr.fieldbus.ethercat.wire.managers import READS, WRITES, Fmmu, SyncManager
from openacr.fieldbus.ethercat.wire.registers import ERROR, Register, State

MS = 1_000_000
OUT, IN = 0x1000, 0x1100
SIZE = 256
OUTPUT = Struct("<HiihHbx")
INPUT = Struct("<HiihiHiiIHbx")


@dataclass
class Bus:
    """The master; every frame takes `cycle_ns`."""

    segment: Segment
    now: int = 0
    cycle_ns: int = MS
    counter: int = 0
    wanted: int = 0  # the working counter of the process data
    outputs: dict[int, bytes] = field(default_factory=dict)
    inputs: dict[int, bytes] = field(default_factory=dict)
    emergencies: list[coe.Emergency] = field(default_factory=list)
    _sizes: dict[int, tuple[int, int]] = field(default_factory=dict)

    def send(self, *asked: Datagram) -> list[Datagram]:
        self.now += self.cycle_ns
        back = self.segment.process(frames.pack(asked), self.now)
        return frames.parse(back) if back else []

    def read(self, slave: int, register: int, size: int) -> bytes:
        (one,) = self.send(frames.by_position(Command.APRD, slave, register, bytes(size)))
        assert one.counter == 1
        return one.data

    def number(self, slave: int, register: int, size: int = 2) -> int:
        return int.from_bytes(self.read(slave, register, size), "little")

    def write(self, slave: int, register: int, data: bytes) -> int:
        (one,) = self.send(frames.by_position(Command.APWR, slave, register, data))
        return one.counter

    # -- states ------------------------------------------------------------------------------

    def ask(self, slave: int, state: int) -> tuple[int, int]:
        """Ask for a state; AL_STATUS and AL_CODE after it."""
        self.write(slave, Register.AL_CONTROL, state.to_bytes(2, "little"))
        return self.number(slave, Register.AL_STATUS), self.number(slave, Register.AL_CODE)

    def mailboxes(self, slave: int) -> None:
        both = SyncManager(OUT, SIZE, 0x26).pack() + SyncManager(IN, SIZE, 0x22).pack()
        self.write(slave, Register.SYNC, both)

    def preop(self, slave: int) -> None:
        self.mailboxes(slave)
        assert self.ask(slave, State.PREOP) == (State.PREOP, 0)

    def map(self, slave: int, outputs: int, inputs: int) -> None:
        """Sync managers and FMMUs of process data, at logical addresses of each slave."""
        syncs = SyncManager(0x1200, outputs, 0x64, activate=bool(outputs)).pack()
        syncs += SyncManager(0x1600, inputs, 0x20, activate=bool(inputs)).pack()
        self.write(slave, Register.SYNC + 16, syncs)
        start = 0x10000 + 0x100 * slave
        fmmus = Fmmu(start, outputs, 0x1200, WRITES).pack()
        fmmus += Fmmu(start + outputs, inputs, 0x1600, READS).pack()
        self.write(slave, Register.FMMU, fmmus)
        self._sizes[slave] = outputs, inputs
        self.outputs.setdefault(slave, bytes(outputs))

    def op(self, slave: int, outputs: int, inputs: int) -> None:
        self.preop(slave)
        self.map(slave, outputs, inputs)
        assert self.ask(slave, State.SAFEOP) == (State.SAFEOP, 0)
        self.write(slave, Register.AL_CONTROL, bytes([State.OP, 0]))
        self.wanted += 2 * bool(outputs) + bool(inputs)
        self.cycle()
        assert self.number(slave, Register.AL_STATUS) == State.OP

    def acknowledge(self, slave: int, state: State) -> tuple[int, int]:
        return self.ask(slave, state | ERROR)

    def cycle(self, count: int = 1) -> int:
        """Exchange the process data; the working counter of the last exchange."""
        counter = 0
        for _ in range(count):
            asked = [
                frames.by_logical(
                    Command.LRW,
                    0x10000 + 0x100 * slave,
                    self.outputs[slave] + bytes(self._sizes[slave][1]),
                )
                for slave in self._sizes
            ]
            back = self.send(*asked)
            counter = sum(one.counter for one in back)
            for slave, one in zip(self._sizes, back, strict=bool(back)):
                self.inputs[slave] = one.data[self._sizes[slave][0] :]
        return counter

    # -- mails -------------------------------------------------------------------------------

    def mail(self, slave: int, payload: bytes) -> None:
        self.counter = mailbox.next_counter(self.counter)
        mail = mailbox.Mail(mailbox.MailType.COE, payload, self.counter)
        assert self.write(slave, OUT, mail.pack().ljust(SIZE, b"\0")) == 1

    def collect(self, slave: int) -> mailbox.Mail:
        return mailbox.Mail.parse(self.read(slave, IN, SIZE))

    def answer(self, slave: int) -> coe.Reply:
        while True:
            service, body = coe.service_of(self.collect(slave).payload)
            if service == coe.Service.EMERGENCY:
                self.emergencies.append(coe.Emergency.parse(body))
                continue
            return coe.parse_reply(body)

    def answer_emergencies(self, slave: int = 0) -> None:
        """Collect the mails that wait."""
        while self.number(slave, Register.SYNC + 13, 1) & 0x08:
            body = coe.service_of(self.collect(slave).payload)[1]
            self.emergencies.append(coe.Emergency.parse(body))

    def sdo(self, slave: int, request: coe.Request) -> coe.Reply:
        self.mail(slave, request.pack())
        return self.answer(slave)

    def upload(self, slave: int, index: int, subindex: int = 0, complete: bool = False) -> bytes:
        first = self.sdo(slave, coe.Upload(index, subindex, complete))
        assert isinstance(first, coe.Uploaded), first
        data, toggle = first.data, False
        while len(data) < first.size:
            part = self.sdo(slave, coe.UploadNext(toggle))
            assert isinstance(part, coe.Segment)
            data, toggle = data + part.data, not toggle
            assert part.is_last == (len(data) == first.size)
        return data

    def download(
        self, slave: int, index: int, subindex: int, data: bytes, complete: bool = False
    ) -> coe.Reply:
        return self.sdo(slave, coe.Download(index, subindex, data, len(data), complete))

    def inform(self, slave: int, payload: bytes) -> sdo_info.Information:
        self.mail(slave, payload)
        parts = []
        while True:
            service, body = coe.service_of(self.collect(slave).payload)
            assert service == coe.Service.INFORMATION
            parts.append(sdo_info.Information.parse(body))
            if not parts[-1].fragments:
                data = b"".join(part.data for part in parts)
                return sdo_info.Information(parts[-1].operation, data)

    # -- drives ------------------------------------------------------------------------------

    def drive(self, slave: int) -> Drive:
        one = self.segment.slaves[slave]
        assert isinstance(one, Drive)
        return one

    def command(
        self,
        slave: int = 0,
        control: int = 0x0F,
        position: int = 0,
        velocity: int = 0,
        torque: int = 0,
        probe: int = 0,
        mode: int = CSP,
    ) -> None:
        self.outputs[slave] = OUTPUT.pack(control, position, velocity, torque, probe, mode)

    def status(self, slave: int = 0) -> int:
        return int.from_bytes(self.inputs[slave][:2], "little")

    def position(self, slave: int = 0) -> int:
        return int(INPUT.unpack(self.inputs[slave])[1])

    def enable(self, slave: int = 0, mode: int = CSP) -> None:
        """From switched off to enabled, at the position where the motor is."""
        for control in (0x06, 0x07, 0x0F):
            self.command(slave, control, position=self.position(slave), mode=mode)
            self.cycle(3)
        assert self.status(slave) & 0x6F == 0x27
