"""`openacr bus watch`: what changes on a bus that no card uses, a line each."""

import time
from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated

import typer

from openacr.cli.bus import Interface, open_bus

if TYPE_CHECKING:
    from openacr.fieldbus.ethercat.master.device import Device

EVERY_S = 0.5
ERRORS, LINKS = slice(0, 8), slice(16, 20)  # of the error registers: of each port


def watch_bus(
    interface: Interface,
    seconds: Annotated[
        float, typer.Option(min=0.0, help="End after that time; 0: with Ctrl-C.")
    ] = 0.0,
) -> None:
    """Print a line for every change of a bus: states, errors, damaged frames, lost links.

    Devices are only asked; counters of frames and links are those of the devices since their power
    came on. A device that does not answer is named.
    """
    with open_bus(interface) as devices:
        begun_s = time.monotonic()
        before = [""] * len(devices)
        while True:
            passed_s = time.monotonic() - begun_s
            for line in changes(devices, before):
                typer.echo(f"{passed_s:8.1f} s  {line}")
            if seconds and passed_s >= seconds:
                return
            time.sleep(EVERY_S)


def changes(devices: "list[Device]", before: list[str]) -> Iterator[str]:
    """A line for each device that is another one than `before`, which is brought up to date."""
    for number, device in enumerate(devices):
        now = _state(device)
        if now != before[number]:
            before[number] = now
            yield f"{device.label}: {now}"


def _state(device: "Device") -> str:
    """The state of a device in a line."""
    from openacr.fieldbus.ethercat.wire.registers import Register, al_text
    from openacr.wording import counted

    found = device.state_now()
    counts = device.registers_now(Register.RX_ERRORS, LINKS.stop)
    if found is None or counts is None:
        return "does not answer"
    state, code = found
    parts = [state.name, al_text(code) if code else ""]
    for what, total in (("damaged frame", sum(counts[ERRORS])), ("lost link", sum(counts[LINKS]))):
        parts.append(counted(total, what) if total else "")
    return ", ".join(part for part in parts if part)
