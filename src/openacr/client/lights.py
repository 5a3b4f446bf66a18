"""The status lights on the front of a card, derived from its parameters and flags."""

from enum import StrEnum

SUPPLIES = 0b1100011  # P7044: ISO, EXT, VEE, VDD
FLASH_INVALID = 0b111 << 24  # flags 5656 to 5658: boot flash and both system flashes


class Light(StrEnum):
    """The state of a status light."""

    OFF = "off"
    GREEN = "green"
    BLINKING_GREEN = "blinking green"
    RED = "red"
    BLINKING_RED = "blinking red"
    RED_AND_GREEN = "red and green in turn"
    ONE_FLASH = "one red flash"
    TWO_FLASHES = "two red flashes"


# By P32779: pre-initialised, ready, started, wrong ids twice, a node is missing, excess bus
# errors, health event, internal error, transmission overflow, bus off.
_BUS = (
    Light.OFF, Light.BLINKING_GREEN, Light.GREEN, Light.RED, Light.RED, Light.BLINKING_GREEN,
    Light.ONE_FLASH, Light.TWO_FLASHES, Light.BLINKING_RED, Light.BLINKING_RED, Light.RED,
)  # fmt: skip


def power_light(*, is_there: bool, diagnostics: int = 0, misc_control: int = 0) -> Light:
    """Power light: off without power, red if a supply fails, red and green after a boot error."""
    if not is_there:
        return Light.OFF
    if misc_control & FLASH_INVALID:
        return Light.RED_AND_GREEN
    return Light.RED if diagnostics & SUPPLIES else Light.GREEN


def axis_light(*, is_faulty: bool, is_enabled: bool) -> Light:
    """Axis light: red with a fault (or no cable: the fault input is on), green if enabled."""
    if is_faulty:
        return Light.RED
    return Light.GREEN if is_enabled else Light.OFF


def bus_light(bus_state: int, *, is_installed: bool) -> Light:
    """CANopen light; off on a card without a CANopen controller."""
    known = is_installed and 0 <= bus_state < len(_BUS)
    return _BUS[bus_state] if known else Light.OFF
