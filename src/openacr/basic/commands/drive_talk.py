"""Drive Talk: a port for the drives, and a terminal that talks to one of them."""

from __future__ import annotations

import re

from openacr.basic.commands.character_io import DEVICES, GROUP, port_name
from openacr.basic.language.grammar import Axes, Axis, Int, Mark, Str
from openacr.basic.language.registry import ANY, IMMEDIATE, PROG, command
from openacr.basic.vm.run import Run, Wait, WaitKind
from openacr.errors import CardError
from openacr.map.rows import drive_talk, drive_talk_lines
from openacr.messages import (
    DEVICE_IN_USE,
    DEVICE_NOT_OPEN,
    INVALID_ARGUMENT,
    INVALID_DEVICE,
    NOT_SUPPORTED,
)
from openacr.network.drivetalk import lines
from openacr.network.drivetalk.requests import ARIES_TYPE

REF = "PG Drive Talk"
_SETTINGS = re.compile(r".*?:\s*(\d*)\s*,?\s*([NOE]?)\s*,?\s*([5-8]?)\s*,?\s*([12]?)\s*")


@command(
    "OPEN DTALK",
    group=GROUP,
    levels=PROG,
    grammar=(Str("device"), Mark("AS"), Mark("#"), Int("d", 1, DEVICES)),
    ref=REF,
)
def open_dtalk(run: Run, device: str, number: int) -> None:
    """Make a port the line to the drives of all axes whose P28672 + 256 n is `d`."""
    name = port_name(device)
    if name not in lines.PORTS:
        raise CardError(INVALID_DEVICE)
    key = (run.needed_program(), number)
    run.system.devices.open(key, name)
    lines.open_line(run.card.memory, name, key, _serial(device))


def _serial(device: str) -> tuple[int, int]:
    """Baud rate and bits of a character; what is left out is 9600,N,8,1."""
    match = _SETTINGS.fullmatch(device.upper())
    baud, parity, data, stop = match.groups() if match else ("", "", "", "")
    bits = 1 + int(data or 8) + (parity in ("O", "E")) + int(stop or 1)
    return int(baud or lines.DEFAULT_BAUD), bits


@command("DTALK", group=GROUP, levels=ANY, use=IMMEDIATE, grammar=(Axes(),), ref=REF)
def dtalk(run: Run, axes: tuple[Axis, ...]) -> Wait | None:
    """Talk to the drive of an axis until ESC; requests of programs wait meanwhile."""
    if len(axes) != 1:
        raise CardError(INVALID_ARGUMENT)
    axis, memory = axes[0].number, run.card.memory
    port = lines.line_of(memory, axis)
    if port is None:
        raise CardError(DEVICE_NOT_OPEN)
    if memory.I[drive_talk.drive_type[axis]] != ARIES_TYPE:
        raise CardError(NOT_SUPPORTED)
    line = lines.TalkLine(memory, port)
    if line.get(drive_talk_lines.channel):
        raise CardError(DEVICE_IN_USE)
    if line.is_busy:
        return Wait(WaitKind.NEXT_SLICE, retry=True)
    run.channel.join_drive(axis, port)
    return None
