"""Describes a bus to the real-time loop: where in the frame is what it takes and gives."""

import math

from openacr.fieldbus.cia402.objects import ACTUAL_POSITION, CONTROL_WORD, MODES, STATUS_WORD
from openacr.fieldbus.ethercat.master.mapping import Signal
from openacr.fieldbus.ethercat.master.master import Master, Member
from openacr.fieldbus.ethercat.master.port import FIRST_STATION, BusError
from openacr.fieldbus.ethercat.wire.frames import (
    DATAGRAM,
    FIRST,
    HEADER_SIZE,
    Command,
    by_station,
    pack,
)
from openacr.fieldbus.ethercat.wire.registers import Register, State
from openacr.fieldbus.machine import exchange_cy as at
from openacr.fieldbus.machine.exchange_memory import ExchangeMemory
from openacr.fieldbus.machine.realtime_drive import RealtimeDrive
from openacr.fieldbus.machine.report import devices_of
from openacr.map.memory import Memory
from openacr.plant import inputs
from openacr.plant.describe.bus_schema import CyclicMode


def numbers_at(place: int) -> int:
    """The first number of a drive."""
    return at.FIRST_NUMBERS + at.DRIVE_NUMBERS * place


class ExchangeLayout:
    """Rows of a bus that has been brought up, while nothing is exchanged; BusError without room."""

    def __init__(self, memory: ExchangeMemory) -> None:
        self.memory = memory

    def frame(self, master: Master, socket: int, cycle_s: float) -> None:
        """The cyclic frame of a master, which Python writes once."""
        rows = self.memory.rows
        cyclic = master.datagrams()
        asks = by_station(Command.FPRD, FIRST_STATION, Register.AL_STATUS, bytes(at.ASK_SIZE))
        datagrams = [*cyclic, asks]
        frame = pack(datagrams)
        self.memory.out[: len(frame)] = frame
        place = FIRST
        starts = []
        for datagram in datagrams:
            starts.append(place)
            place += HEADER_SIZE + len(datagram.data) + 2
        rows[at.SOCKET], rows[at.FRAME_SIZE] = socket, len(frame)
        rows[at.DATAGRAMS] = len(datagrams)
        for number, start in enumerate(starts):
            rows[at.INDEX_AT + number] = start + 1
        rows[at.IMAGE_AT] = starts[0] + DATAGRAM.size
        rows[at.COUNTER_AT] = starts[0] + DATAGRAM.size + len(datagrams[0].data)
        rows[at.CLOCK_AT] = starts[2] + DATAGRAM.size if len(cyclic) > 2 else 0
        self._devices(master, starts[-1])
        self.memory.numbers[at.CYCLE_NS] = round(1e9 * cycle_s)
        rows[at.COUNTER] = master.counter
        rows[at.STATUS_AT] = starts[1] + DATAGRAM.size
        rows[at.FORBIDDEN] = master.forbidden
        rows[at.OPERATING] = State.OP
        rows[at.OUTPUTS_SIZE] = sum(member.outputs.size for member in master.members)

    def _devices(self, master: Master, ask_at: int) -> None:
        """Let the loop ask each device for its state, one in each frame."""
        rows = self.memory.rows
        if len(master.devices) > at.MOST_DEVICES:
            raise BusError(
                f"{len(master.devices)} devices on the bus: the real-time loop has room for"
                f" {at.MOST_DEVICES}"
            )
        for place, shown in enumerate(devices_of(master)):
            r = at.FIRST_DEVICE + at.DEVICE_ROWS * place
            rows[r + at.AL_STATUS], rows[r + at.AL_CODE] = State[shown["state"]], 0
        rows[at.ASK_AT], rows[at.STATION] = ask_at, FIRST_STATION
        rows[at.DEVICES], rows[at.ASKED] = len(master.devices), 0

    def drive(self, place: int, drive: RealtimeDrive, member: Member) -> None:
        """Where a drive is in the image, and how it counts."""
        rows, numbers = self.memory.rows, self.memory.numbers
        r, f = at.FIRST_DRIVE + at.DRIVE_ROWS * place, numbers_at(place)
        target = Signal.of(MODES[drive.table.mode].target, member.outputs, member.outputs_at)
        rows[r + at.READY] = rows[r + at.FAILED] = rows[r + at.IS_KNOWN] = 0
        rows[r + at.CONTROL_AT] = Signal.of(CONTROL_WORD, member.outputs, member.outputs_at).at
        rows[r + at.TARGET_AT], rows[r + at.TARGET_SIZE] = target.at, target.form.size
        rows[r + at.STATE_AT] = Signal.of(STATUS_WORD, member.inputs, member.inputs_at).at
        rows[r + at.ACTUAL_AT] = Signal.of(ACTUAL_POSITION, member.inputs, member.inputs_at).at
        rows[r + at.IS_POSITION] = int(drive.table.mode is CyclicMode.CSP)
        rows[r + at.MOTOR] = drive.axis.number
        numbers[f + at.SCALE] = drive.scale
        numbers[f + at.PER_VOLT] = math.copysign(drive.table.per_volt or 0.0, drive.scale)
        numbers[f + at.FASTEST_CPS] = drive.fastest_cps
        drive.follow(numbers, f)
        rows[at.DRIVES] = place + 1

    def contacts(
        self, memory: Memory, contacts: list[tuple[int, int]], outputs: list[tuple[int, int]]
    ) -> None:
        """Inputs and outputs of the card, each with its bit of the image."""
        rows = self.memory.rows
        found = []
        for flag, bit in contacts:
            slot = inputs.driven_slot(memory, flag)
            if slot is not None:
                found.append((bit // 8, bit % 8, *inputs.input_place(flag), slot))
        rows[at.INPUTS] = len(found)
        found += [(bit // 8, bit % 8, *inputs.output_place(flag), 0) for flag, bit in outputs]
        rows[at.OUTPUTS] = len(outputs)
        if len(found) > at.MOST_CONTACTS:
            raise BusError(
                f"{len(found)} contacts on the bus: the real-time loop has room for"
                f" {at.MOST_CONTACTS}"
            )
        for number, contact in enumerate(found):
            first = at.FIRST_CONTACT + at.CONTACT_ROWS * number
            for offset, value in enumerate(contact):
                rows[first + offset] = value
