"""The RS-485 lines to the drives: every drive on a line receives everything sent on it."""

from __future__ import annotations

from openacr.map.memory import Memory
from openacr.map.rows import bus_drives
from openacr.plant.bus.aries import Drive, drives
from openacr.plant.bus.aries_port import answer, split_address

CHARACTER_BITS = 10  # of drives: start bit, 8 data bits, no parity, stop bit


def exchange(
    memory: Memory, port: int, baud: int, character_bits: int, line: str, axis: int | None = None
) -> list[str]:
    """Send a line; returns the answers of the addressed drives.

    With an address only the drive that has it answers. `axis`: sent on the connector of
    that axis alone, as for drives that have no address yet.
    """
    address, commands = split_address(line)
    return [
        answer(drive, commands)
        for drive in drives(memory)
        if axis in (None, drive.axis)
        and _understands(drive, port, baud, character_bits)
        and address in (None, drive.whole(bus_drives.address))
    ]


def _understands(drive: Drive, port: int, baud: int, character_bits: int) -> bool:
    is_wired = drive.whole(bus_drives.port) == port and drive.hears
    return is_wired and (drive.whole(bus_drives.baud), CHARACTER_BITS) == (baud, character_bits)
