"""The EEPROM interface of a slave: reads and writes words of the SII by its registers."""

from openacr.fieldbus.ethercat.wire.registers import Eeprom, Register
from openacr.fieldbus.ethercat.wire.sii import ALIAS_WORD

READ_BYTES = 8
_COMMANDS = Eeprom.READ | Eeprom.WRITE | Eeprom.RELOAD
_IDLE = Eeprom.READS_8 | Eeprom.TWO_BYTE_ADDRESS


class EepromInterface:
    """Serves the commands at once; `data` is what the EEPROM holds."""

    def __init__(self, registers: bytearray, data: bytes) -> None:
        self._registers = registers
        self.data = bytearray(data)
        self.reset()

    def reset(self) -> None:
        """Power is switched on: the alias is loaded."""
        self._put(Register.EEPROM_CONTROL, int(_IDLE).to_bytes(2, "little"))
        self._put(Register.ALIAS, self.data[2 * ALIAS_WORD : 2 * ALIAS_WORD + 2])

    def written(self) -> None:
        """EEPROM_CONTROL was written: do what it says."""
        control = int.from_bytes(self._get(Register.EEPROM_CONTROL, 2), "little")
        command = control & _COMMANDS
        address = 2 * int.from_bytes(self._get(Register.EEPROM_ADDRESS, 4), "little")
        error = Eeprom(0)
        if command == Eeprom.READ:
            part = self.data[address : address + READ_BYTES].ljust(READ_BYTES, b"\xff")
            self._put(Register.EEPROM_DATA, part)
        elif command == Eeprom.WRITE:
            error = self._write(control, address)
        elif command == Eeprom.RELOAD:
            self._put(Register.ALIAS, self.data[2 * ALIAS_WORD : 2 * ALIAS_WORD + 2])
        elif command:
            error = Eeprom.COMMAND_ERROR
        self._put(Register.EEPROM_CONTROL, int(_IDLE | error).to_bytes(2, "little"))

    def _write(self, control: int, address: int) -> Eeprom:
        if not control & Eeprom.WRITE_ENABLE:
            return Eeprom.ENABLE_ERROR
        if address + 2 > len(self.data):
            return Eeprom.COMMAND_ERROR
        self.data[address : address + 2] = self._get(Register.EEPROM_DATA, 2)
        return Eeprom(0)

    def _get(self, register: int, size: int) -> bytearray:
        return self._registers[register : register + size]

    def _put(self, register: int, data: bytes | bytearray) -> None:
        self._registers[register : register + len(data)] = data
