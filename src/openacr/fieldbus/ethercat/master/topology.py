"""Where each device is attached: a frame runs through branches depth first.

It enters a device at port 0 and leaves it at ports 3, 1 and 2, so the next device found is at the
first open port that no device has yet, of the latest device that has one.
"""

from collections.abc import Iterable, Sequence
from typing import NamedTuple

DOWNSTREAM = (3, 1, 2)  # in the order of a frame
LINE_PORT = 1  # of a device with one neighbour after it
_COMMUNICATES = 0x0200  # of DL_STATUS, port 0; two bits further for each next one


class Place(NamedTuple):
    """The device before one, by its position, and its port."""

    device: int
    port: int


def open_ports(status: int) -> list[int]:
    """The ports after a device at which others answer, in the order of a frame (DL_STATUS)."""
    return [port for port in DOWNSTREAM if status & _COMMUNICATES << 2 * port]


def places(ports: Sequence[Iterable[int]]) -> list[Place | None]:
    """Where each device is attached, by the open ports of all; None for the first one."""
    free: list[Place] = []
    found: list[Place | None] = []
    for position, own in enumerate(ports):
        # Without a free port a cable was pulled out meanwhile: what answered is in a line.
        found.append((free.pop() if free else Place(position - 1, LINE_PORT)) if position else None)
        free += reversed([Place(position, port) for port in own])
    return found
