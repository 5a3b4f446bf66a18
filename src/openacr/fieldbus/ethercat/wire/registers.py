"""The registers of a slave controller, its states and what it says of errors (ETG.1000.4)."""

from enum import IntEnum, IntFlag


class Register(IntEnum):
    """Addresses of the registers."""

    TYPE = 0x0000  # byte
    REVISION = 0x0001  # byte
    BUILD = 0x0002  # word
    FMMU_COUNT = 0x0004  # byte
    SYNC_COUNT = 0x0005  # byte: sync managers
    RAM_KB = 0x0006  # byte
    PORTS = 0x0007  # byte: two bits a port
    FEATURES = 0x0008  # word: Feature
    STATION = 0x0010  # word
    ALIAS = 0x0012  # word, from the EEPROM
    DL_CONTROL = 0x0100  # 4 bytes
    DL_STATUS = 0x0110  # word
    AL_CONTROL = 0x0120  # word
    AL_STATUS = 0x0130  # word
    AL_CODE = 0x0134  # word: AL_CODES
    PDI_CONTROL = 0x0140  # word
    EVENT_MASK = 0x0200  # word
    AL_EVENT = 0x0220  # 4 bytes
    RX_ERRORS = 0x0300  # two bytes a port: invalid frames, physical errors
    FORWARDED_ERRORS = 0x0308  # a byte a port
    UNIT_ERRORS = 0x030C  # byte: malformed EtherCAT frames
    LOST_LINKS = 0x0310  # a byte a port
    WATCHDOG_DIVIDER = 0x0400  # word: (n + 2) * 40 ns
    PDI_WATCHDOG = 0x0410  # word, in units of the divider
    SYNC_WATCHDOG = 0x0420  # word, in units of the divider
    WATCHDOG_STATUS = 0x0440  # word: 1 while the outputs are refreshed in time
    WATCHDOG_COUNT = 0x0442  # byte: how often it expired
    EEPROM_CONFIG = 0x0500  # byte
    EEPROM_ACCESS = 0x0501  # byte
    EEPROM_CONTROL = 0x0502  # word: Eeprom
    EEPROM_ADDRESS = 0x0504  # 4 bytes, in words
    EEPROM_DATA = 0x0508  # 8 bytes
    FMMU = 0x0600  # 16 bytes each: wire.managers
    SYNC = 0x0800  # 8 bytes each: wire.managers
    RECEIVE_TIMES = 0x0900  # 4 bytes a port; a write of the first latches all
    SYSTEM_TIME = 0x0910  # 8 bytes [ns]
    RECEIVE_TIME = 0x0918  # 8 bytes: of the processing unit
    TIME_OFFSET = 0x0920  # 8 bytes [ns]
    TIME_DELAY = 0x0928  # 4 bytes [ns]
    TIME_DIFFERENCE = 0x092C  # 4 bytes: sign and size
    SPEED_START = 0x0930  # word
    TIME_FILTERS = 0x0934  # 2 bytes
    CYCLIC_UNIT = 0x0980  # byte
    ACTIVATION = 0x0981  # byte: Activation
    PULSE_LENGTH = 0x0982  # word
    SYNC0_STATUS = 0x098E  # byte
    SYNC0_START = 0x0990  # 8 bytes [ns]
    SYNC1_NEXT = 0x0998  # 8 bytes [ns]
    SYNC0_CYCLE = 0x09A0  # 4 bytes [ns]
    SYNC1_CYCLE = 0x09A4  # 4 bytes [ns]
    MEMORY = 0x1000  # mailboxes and process data


class Feature(IntFlag):
    """Bits of FEATURES."""

    NO_BIT_FMMU = 0x0001  # 1: FMMUs map bytes only
    CLOCK = 0x0004
    CLOCK_64 = 0x0008


class State(IntEnum):
    """States of a slave (AL), in AL_CONTROL and AL_STATUS."""

    INIT = 1
    PREOP = 2
    BOOT = 3
    SAFEOP = 4
    OP = 8


ERROR = 0x10  # of AL_STATUS: it went down by itself or refused; of AL_CONTROL: acknowledged
STATE_MASK = 0x0F


class Eeprom(IntFlag):
    """Bits of EEPROM_CONTROL."""

    WRITE_ENABLE = 0x0001
    READS_8 = 0x0040  # 8 bytes a read, otherwise 4
    TWO_BYTE_ADDRESS = 0x0080
    READ = 0x0100
    WRITE = 0x0200
    RELOAD = 0x0400
    CHECKSUM_ERROR = 0x0800
    NOT_LOADED = 0x1000
    COMMAND_ERROR = 0x2000
    ENABLE_ERROR = 0x4000
    BUSY = 0x8000


class Activation(IntFlag):
    """Bits of ACTIVATION."""

    CYCLIC = 0x01
    SYNC0 = 0x02
    SYNC1 = 0x04


class AlCode(IntEnum):
    """Codes of AL_CODE; `text` says them."""

    NONE = 0x0000
    UNSPECIFIED = 0x0001
    NO_MEMORY = 0x0002
    INVALID_CHANGE = 0x0011
    UNKNOWN_STATE = 0x0012
    NO_BOOT = 0x0013
    NO_FIRMWARE = 0x0014
    BOOT_MAILBOX = 0x0015
    MAILBOX = 0x0016
    SYNC_MANAGERS = 0x0017
    NO_INPUTS = 0x0018
    NO_OUTPUTS = 0x0019
    SYNCHRONIZATION = 0x001A
    WATCHDOG = 0x001B
    SYNC_TYPES = 0x001C
    OUTPUT_SIZE = 0x001D
    INPUT_SIZE = 0x001E
    WATCHDOG_SETTING = 0x001F
    COLD_START = 0x0020
    NEEDS_INIT = 0x0021
    NEEDS_PREOP = 0x0022
    NEEDS_SAFEOP = 0x0023
    INPUT_MAPPING = 0x0024
    OUTPUT_MAPPING = 0x0025
    INCONSISTENT = 0x0026
    NO_FREE_RUN = 0x0027
    NO_SYNC_MODE = 0x0028
    FREE_RUN_BUFFERS = 0x0029
    BACKGROUND_WATCHDOG = 0x002A
    NO_PROCESS_DATA = 0x002B
    FATAL_SYNC = 0x002C
    NO_SYNC = 0x002D
    CYCLE_TOO_SHORT = 0x002E
    CLOCK_SYNC = 0x0030
    CLOCK_LATCH = 0x0031
    PLL = 0x0032
    CLOCK_IO = 0x0033
    CLOCK_TIMEOUT = 0x0034
    CLOCK_CYCLE = 0x0035
    SYNC0_CYCLE = 0x0036
    SYNC1_CYCLE = 0x0037
    EEPROM_NO_ACCESS = 0x0050
    EEPROM = 0x0051
    RESTARTED = 0x0060

    @property
    def text(self) -> str:
        """What it means."""
        return _TEXTS[self]


_TEXTS = {
    AlCode.NONE: "no error",
    AlCode.UNSPECIFIED: "unspecified error",
    AlCode.NO_MEMORY: "no memory",
    AlCode.INVALID_CHANGE: "invalid requested state change",
    AlCode.UNKNOWN_STATE: "unknown requested state",
    AlCode.NO_BOOT: "bootstrap not supported",
    AlCode.NO_FIRMWARE: "no valid firmware",
    AlCode.BOOT_MAILBOX: "invalid mailbox configuration (bootstrap)",
    AlCode.MAILBOX: "invalid mailbox configuration",
    AlCode.SYNC_MANAGERS: "invalid sync manager configuration",
    AlCode.NO_INPUTS: "no valid inputs available",
    AlCode.NO_OUTPUTS: "no valid outputs",
    AlCode.SYNCHRONIZATION: "synchronization error",
    AlCode.WATCHDOG: "sync manager watchdog",
    AlCode.SYNC_TYPES: "invalid sync manager types",
    AlCode.OUTPUT_SIZE: "invalid output configuration",
    AlCode.INPUT_SIZE: "invalid input configuration",
    AlCode.WATCHDOG_SETTING: "invalid watchdog configuration",
    AlCode.COLD_START: "slave needs a cold start",
    AlCode.NEEDS_INIT: "slave needs INIT",
    AlCode.NEEDS_PREOP: "slave needs PREOP",
    AlCode.NEEDS_SAFEOP: "slave needs SAFEOP",
    AlCode.INPUT_MAPPING: "invalid input mapping",
    AlCode.OUTPUT_MAPPING: "invalid output mapping",
    AlCode.INCONSISTENT: "inconsistent settings",
    AlCode.NO_FREE_RUN: "free run not supported",
    AlCode.NO_SYNC_MODE: "synchronization mode not supported",
    AlCode.FREE_RUN_BUFFERS: "free run needs the mode of three buffers",
    AlCode.BACKGROUND_WATCHDOG: "background watchdog",
    AlCode.NO_PROCESS_DATA: "no valid inputs and outputs",
    AlCode.FATAL_SYNC: "fatal synchronization error",
    AlCode.NO_SYNC: "no synchronization signal",
    AlCode.CYCLE_TOO_SHORT: "cycle time too short",
    AlCode.CLOCK_SYNC: "invalid configuration of the clock's SYNC signals",
    AlCode.CLOCK_LATCH: "invalid configuration of the clock's latches",
    AlCode.PLL: "clock not locked",
    AlCode.CLOCK_IO: "invalid clock I/O",
    AlCode.CLOCK_TIMEOUT: "clock timeout",
    AlCode.CLOCK_CYCLE: "invalid cycle time of the clock",
    AlCode.SYNC0_CYCLE: "invalid cycle time of SYNC0",
    AlCode.SYNC1_CYCLE: "invalid cycle time of SYNC1",
    AlCode.EEPROM_NO_ACCESS: "no access to the EEPROM",
    AlCode.EEPROM: "EEPROM error",
    AlCode.RESTARTED: "slave restarted by itself",
}


def al_text(code: int) -> str:
    """What an AL status code means; codes of manufacturers by their number."""
    try:
        return AlCode(code).text
    except ValueError:
        return f"AL status code 0x{code:04X}"
