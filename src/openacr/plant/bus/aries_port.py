"""The serial protocol of Aries drives: command lines and their answers.

    TPE          -> *2576            report a value
    DMODE        -> *2               report a setting
    SMPER4000    -> (empty line)     change it
    3_TPE        -> *2576            the same, for the drive with address 3

Several commands in a line are separated by colons.
"""

from __future__ import annotations

import re
from collections.abc import Callable

from openacr.map.rows import bus_drives, motors
from openacr.plant.bus import aries
from openacr.plant.bus.aries import SETTINGS, Drive

WORD_BITS = 32
HIGHEST_ADDRESS = 99
NO_COMMAND, NO_DATA = "*UNDEFINED COMMAND", "*INVALID DATA"

_COMMAND = re.compile(r"([A-Z]+)(-?[\d._]*(?:E[-+]?\d+)?)")
_PREFIX = re.compile(r"(\d{1,2})_(.*)", re.DOTALL)


def split_address(line: str) -> tuple[int | None, str]:
    """The address in front of a line, and the rest."""
    match = _PREFIX.fullmatch(line)
    return (int(match[1]), match[2]) if match else (None, line)


def only_reads(line: str) -> bool:
    """Whether a line changes nothing of the drive that gets it."""
    commands = [part.strip().upper() for part in split_address(line)[1].split(":")]
    return all(not command or command in _READERS or command in _TEXTS for command in commands)


def answer(drive: Drive, line: str) -> str:
    """The drive's answer to the commands of a line, which has no address in front."""
    aries.notice_errors(drive)
    replies = [_reply(drive, part.strip().upper()) for part in line.split(":")]
    return "".join(f"{reply}\r\n" for reply in replies)


def _reply(drive: Drive, command: str) -> str:
    match = _COMMAND.fullmatch(command)
    if match is None:
        return NO_COMMAND if command else ""
    word, value = match[1], match[2]
    if value and word in _WRITERS:
        return "" if _WRITERS[word](drive, value) else NO_DATA
    if not value and word in _READERS:
        return f"*{_READERS[word](drive)}"
    return _TEXTS[word](drive) if word in _TEXTS and not value else NO_COMMAND


def bits_text(bits: int) -> str:
    """Thirty-two bits as drives print them: bit 0 first, in groups of four."""
    digits = "".join(str(bits >> bit & 1) for bit in range(WORD_BITS))
    return "_".join(digits[place : place + 4] for place in range(0, WORD_BITS, 4))


def bits_of(text: str) -> int | None:
    """The bits of a text made by `bits_text`; None for any other text."""
    digits = text.replace("_", "")
    if len(digits) > WORD_BITS or not digits or set(digits) - {"0", "1"}:
        return None
    return sum(1 << bit for bit, digit in enumerate(digits) if digit == "1")


def _set(index: int) -> Callable[[Drive, str], bool]:
    def write(drive: Drive, text: str) -> bool:
        try:
            return aries.change_setting(drive, index, float(text))
        except ValueError:
            return False

    return write


def _set_address(drive: Drive, text: str) -> bool:
    if not text.isdigit() or int(text) > HIGHEST_ADDRESS:
        return False
    drive.put_whole(bus_drives.address, int(text))
    return True


def _select_errors(drive: Drive, text: str) -> bool:
    bits = bits_of(text)
    if bits is None:
        return False
    drive.put_whole(bus_drives.selection, bits if bits < 2**31 else bits - 2**32)
    return True


def number_text(value: float) -> str:
    """A number as drives print it."""
    return f"{value:.7g}"


def _number(value_of: Callable[[Drive], float]) -> Callable[[Drive], str]:
    return lambda drive: number_text(value_of(drive))


def _setting(index: int) -> Callable[[Drive], str]:
    return _number(lambda drive: drive.setting(index))


_READERS: dict[str, Callable[[Drive], str]] = {
    "TPC": lambda drive: str(aries.commanded(drive)),
    "TPE": lambda drive: str(aries.following_error(drive)),
    "TENC": lambda drive: str(round(drive.motor(motors.raw_count))),
    "TVEL": _number(aries.velocity),
    "TVELC": _number(aries.commanded_speed),
    "TVE": _number(aries.speed_error),
    "TANI": _number(lambda drive: drive.motor(motors.volts)),
    "TCI": _number(aries.current),
    "TTRQ": _number(aries.torque),
    "TDIMAX": _number(lambda drive: drive.setting(aries.DMTIP)),
    "TDTEMP": _number(lambda drive: drive.real(bus_drives.drive_temp_c)),
    "TMTEMP": _number(lambda drive: drive.real(bus_drives.motor_temp_c)),
    "TDBUS": _number(lambda drive: drive.real(bus_drives.bus_v)),
    "TDHRS": lambda drive: str(aries.age_s(drive) // 3600),
    "TDMIN": lambda drive: str(aries.age_s(drive) // 60 % 60),
    "TDSEC": lambda drive: str(aries.age_s(drive) % 60),
    "TADDR": lambda drive: str(drive.whole(bus_drives.address)),
    "DRIVE": lambda drive: str(int(aries.is_enabled(drive))),
    "ADDR": lambda drive: str(drive.whole(bus_drives.address)),
    "TAS": lambda drive: bits_text(aries.status(drive)),
    "TASX": lambda drive: bits_text(aries.errors(drive)),
    "ERRORL": lambda drive: bits_text(drive.whole(bus_drives.selection)),
    **{setting.word: _setting(index) for index, setting in enumerate(SETTINGS)},
}
_WRITERS: dict[str, Callable[[Drive, str], bool]] = {
    "ADDR": _set_address,
    "ERRORL": _select_errors,
    **{setting.word: _set(index) for index, setting in enumerate(SETTINGS)},
}


def _log(drive: Drive) -> str:
    return "\r\n".join(f"*{line}" for line in aries.log(drive) or ["NO ERRORS"])


def _revision(drive: Drive) -> str:
    revision = drive.whole(bus_drives.revision)
    return f"\r\n*Aries OS Revision {revision // 100}.{revision % 100:02d}"


_TEXTS: dict[str, Callable[[Drive], str]] = {"TREV": _revision, "TERRLG": _log}
