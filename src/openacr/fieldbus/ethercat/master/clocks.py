"""Distributed clocks: the first device that has one is the clock of all, SYNC0 its signal.

Delays are those of devices in a line: half of what a device and all after it take, less half of
what the next one and all after it take.
"""

from openacr.fieldbus.ethercat.master.device import Device
from openacr.fieldbus.ethercat.master.port import Port
from openacr.fieldbus.ethercat.wire.frames import Command, by_station
from openacr.fieldbus.ethercat.wire.registers import Activation, Feature, Register

START_NS = 100_000_000  # SYNC0 begins that much later than it is asked for
SETTLING = 200  # frames that bring the clocks together
NEXT_IS_THERE = 0x0800  # of DL_STATUS: port 1 communicates
_WORD_64 = 1 << 64


def synchronize(port: Port, devices: list[Device], cycle_s: float) -> int | None:
    """Let the clocks of all devices that have one run together; the station of the first.

    None without any. SYNC0 comes every `cycle_s`.
    """
    with_clock = [d for d in devices if port.word(d.station, Register.FEATURES) & Feature.CLOCK]
    if not with_clock:
        return None
    port.ask(by_station(Command.BWR, 0, Register.RECEIVE_TIMES, bytes(4)))
    local = [_number(port, device, Register.RECEIVE_TIME, 8) for device in with_clock]
    spans = [_span(port, device) for device in with_clock]
    delay_ns = 0
    for place, device in enumerate(with_clock):
        if place:
            delay_ns += max(0, spans[place - 1] - spans[place]) // 2
        offset = (local[0] - local[place]) % _WORD_64
        port.write(device.station, Register.TIME_OFFSET, offset.to_bytes(8, "little"))
        port.write(device.station, Register.TIME_DELAY, delay_ns.to_bytes(4, "little"))
    reference = with_clock[0].station
    for _ in range(SETTLING):
        port.once([by_station(Command.FRMW, reference, Register.SYSTEM_TIME, bytes(8))])
    cycle_ns = round(cycle_s * 1e9)
    now_ns = _number(port, with_clock[0], Register.SYSTEM_TIME, 8)
    start_ns = ((now_ns + START_NS) // cycle_ns + 1) * cycle_ns
    for device in with_clock:
        port.write(device.station, Register.ACTIVATION, b"\0")
        port.write(device.station, Register.SYNC0_CYCLE, cycle_ns.to_bytes(4, "little"))
        port.write(device.station, Register.SYNC0_START, start_ns.to_bytes(8, "little"))
        on = Activation.CYCLIC | Activation.SYNC0
        port.write(device.station, Register.ACTIVATION, bytes([on]))
    return reference


def _span(port: Port, device: Device) -> int:
    """From the arrival of a frame at a device to its return from those after it [ns]."""
    if not port.word(device.station, Register.DL_STATUS) & NEXT_IS_THERE:
        return 0
    data = port.read(device.station, Register.RECEIVE_TIMES, 8)
    there, back = int.from_bytes(data[:4], "little"), int.from_bytes(data[4:], "little")
    return (back - there) % (1 << 32)


def _number(port: Port, device: Device, register: int, size: int) -> int:
    return int.from_bytes(port.read(device.station, register, size), "little")
