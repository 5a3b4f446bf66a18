"""Reading the EEPROM of a device through its registers."""

from openacr.fieldbus.ethercat.master.port import FIRST_STATION, BusError, Port
from openacr.fieldbus.ethercat.wire import sii
from openacr.fieldbus.ethercat.wire.registers import Eeprom, Register

PATIENCE_S = 0.1  # of one read
POLL_S = 0.0002
MOST_BYTES = 2 * sii.LONGEST_WORDS


def description(port: Port, station: int) -> sii.Description:
    """What the EEPROM of a device says; BusError if it cannot be read."""
    port.write(station, Register.EEPROM_CONFIG, b"\0")  # the master has access
    data = bytearray()
    while not _is_whole(data):
        if len(data) >= MOST_BYTES:
            raise BusError(f"{_name(station)}: its EEPROM has no end")
        data += _read(port, station, len(data) // 2)
    return sii.parse(bytes(data))


def _is_whole(data: bytearray) -> bool:
    """Whether the category that ends the EEPROM has been read."""
    place = 2 * sii.CATEGORIES_WORD
    while place + 4 <= len(data):
        kind = int.from_bytes(data[place : place + 2], "little")
        if kind == sii.Category.END:
            return True
        place += 4 + 2 * int.from_bytes(data[place + 2 : place + 4], "little")
    return False


def _read(port: Port, station: int, word: int) -> bytes:
    """The next 4 or 8 bytes, as the device delivers them."""
    control = _settled(port, station)
    order = Eeprom.READ.to_bytes(2, "little") + word.to_bytes(4, "little")
    port.write(station, Register.EEPROM_CONTROL, order)
    control = _settled(port, station)
    if control & (Eeprom.COMMAND_ERROR | Eeprom.NOT_LOADED):
        raise BusError(f"{_name(station)}: its EEPROM cannot be read at word {word}")
    size = 8 if control & Eeprom.READS_8 else 4
    return port.read(station, Register.EEPROM_DATA, size)


def _settled(port: Port, station: int) -> int:
    """The control word once the EEPROM is not busy."""
    deadline_s = port.link.now_s() + PATIENCE_S
    while (control := port.word(station, Register.EEPROM_CONTROL)) & Eeprom.BUSY:
        if port.link.now_s() > deadline_s:
            raise BusError(f"{_name(station)}: its EEPROM is busy for more than {PATIENCE_S} s")
        port.link.pause(POLL_S)
    return control


def _name(station: int) -> str:
    return f"device {station - FIRST_STATION}"
