"""Non-volatile: saved parameters, user flash, battery, firmware, programs that start alone."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

import msgspec

from openacr.basic.language import registry
from openacr.basic.language.grammar import Int, Word
from openacr.basic.language.registry import ANY, IMMEDIATE, PROG, SYS
from openacr.basic.memory import user_memory
from openacr.basic.vm.run import Run
from openacr.errors import CardError
from openacr.messages import NOT_SUPPORTED, PROGRAMS_RUNNING
from openacr.models import Feature
from openacr.motion.interlocks import axis_moving

GROUP = "Non-Volatile"
REF = "PG Non-Volatile"
command = partial(registry.command, group=GROUP, ref=REF)
BANKS = 16
BANK_BYTES = 1 << 16  # what the 16-bit addresses of Intel-HEX records reach
RECORD_BYTES = 16
DATA, END = 0, 1


@command("PBOOT", levels=ANY, ref="PG Startup Programs")
def pboot(run: Run) -> None:
    """As first statement, start the program at power-up; typed, start all such programs."""
    if not run.stored:
        run.system.start_boot_programs()


def _needs_halted(run: Run) -> None:
    if any(run.system.control.is_running(owner) for owner in run.system.owners()):
        raise CardError(PROGRAMS_RUNNING)


# parameters


@command("ESAVE", levels=SYS | PROG)
def esave(run: Run) -> None:
    """Save the parameters: attachments, gains, limits, profiles, hardware and network."""
    run.system.nonvolatile.esave()


@command("ELOAD", levels=SYS, use=IMMEDIATE)
def eload(run: Run) -> None:
    """Load the saved parameters now, as every power-up does."""
    _needs_halted(run)
    if any(axis_moving(run.card, axis) for axis in range(run.card.model.axes)):
        raise CardError(PROGRAMS_RUNNING)
    run.system.nonvolatile.eload()


@command("ERASE", levels=SYS, use=IMMEDIATE)
def erase(run: Run) -> None:
    """Forget the saved parameters; those in use stay until the next power-up."""
    run.system.nonvolatile.erase()


# flash and battery


@command(
    "FLASH",
    levels=SYS,
    use=IMMEDIATE,
    grammar=(Word("ERASE", "IMAGE", "LOAD", "RES", "SAVE"),),
    needs=Feature.USER_FLASH,
)
def flash(run: Run, what: str) -> None:
    """Save programs (IMAGE: variables too) in user flash, load, erase, or restart from it."""
    _needs_halted(run)
    store = run.system.nonvolatile
    if what == "ERASE":
        store.flash_erase()
    elif what in ("SAVE", "IMAGE"):
        store.flash_save(values=what == "IMAGE")
    else:
        store.flash_load()
        if what == "RES":
            run.system.start_boot_programs()


@command("BRESET", levels=SYS, use=IMMEDIATE)
def breset(run: Run) -> None:
    """Disable the battery backup until power is removed; REBOOT then forgets all programs."""
    run.system.nonvolatile.breset()


# firmware and PROM


@command(
    "FIRMWARE", levels=SYS, use=IMMEDIATE, grammar=(Word("BACKUP", "CHECKSUM", "LOAD", "UPGRADE"),)
)
def firmware(run: Run, what: str) -> None:
    """Back the firmware up, or compute its checksums (P7104 to P7117, BIT5656 to BIT5660)."""
    if what == "BACKUP":
        run.system.nonvolatile.firmware_backup()
    elif what == "CHECKSUM":
        run.system.nonvolatile.firmware_checksum()
    else:
        raise CardError(NOT_SUPPORTED)


@command("PROM", levels=SYS, use=IMMEDIATE, grammar=(Int("bank", 0, BANKS - 1),))
def prom(run: Run, bank: int) -> None:
    """Print a bank of 64 KB of the image of user memory as Intel-HEX records."""
    run.system.programs.check_readable()
    image = msgspec.msgpack.encode(user_memory.take(run.system, values=True))
    for record in hex_records(image[bank * BANK_BYTES : (bank + 1) * BANK_BYTES]):
        run.print(record)


def hex_records(data: bytes) -> Iterator[str]:
    """Intel-HEX lines of up to 16 bytes, and the one that ends the file."""
    for address in range(0, len(data), RECORD_BYTES):
        yield _record(DATA, address, data[address : address + RECORD_BYTES])
    yield _record(END, 0, b"")


def _record(kind: int, address: int, data: bytes) -> str:
    """Length, address, kind and data; the last byte makes the sum of all a multiple of 256."""
    content = bytes((len(data), address >> 8, address & 0xFF, kind)) + data
    return f":{(content + bytes((-sum(content) & 0xFF,))).hex().upper()}"
