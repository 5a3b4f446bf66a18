"""What the error codes of drives (0x603F) mean, as IEC 61800-7-201 groups them."""

_TEXTS = {
    0x1000: "fault without a kind",
    0x2000: "current",
    0x2200: "current inside the drive",
    0x2300: "current at the motor",
    0x2310: "continuous overcurrent at the motor",
    0x2320: "short circuit or earth leakage at the motor",
    0x2330: "earth leakage at the motor",
    0x2340: "short circuit at the motor",
    0x3000: "voltage",
    0x3100: "mains voltage",
    0x3110: "mains voltage too high",
    0x3120: "mains voltage too low",
    0x3130: "a phase of the mains is missing",
    0x3200: "voltage of the DC link",
    0x3210: "voltage of the DC link too high",
    0x3220: "voltage of the DC link too low",
    0x4000: "temperature",
    0x4100: "temperature around the drive",
    0x4200: "temperature of the drive",
    0x4210: "drive too hot",
    0x4300: "temperature of the motor",
    0x4310: "motor too hot",
    0x5000: "hardware of the drive",
    0x5100: "supply of the electronics",
    0x5400: "power stage",
    0x5500: "memory of the drive",
    0x6000: "software of the drive",
    0x6300: "parameters of the drive",
    0x6320: "wrong parameter",
    0x7000: "a module at the drive",
    0x7100: "power",
    0x7120: "motor",
    0x7121: "motor blocked",
    0x7122: "wrong commutation",
    0x7300: "sensor",
    0x7305: "encoder 1",
    0x7306: "encoder 2",
    0x7500: "communication",
    0x8000: "supervision",
    0x8100: "communication",
    0x8300: "torque controller",
    0x8311: "torque too high",
    0x8400: "speed controller",
    0x8500: "position controller",
    0x8600: "positioning",
    0x8611: "following error",
    0x8612: "a limit of travel",
    0x9000: "external fault",
    0xF000: "further functions",
    0xFF00: "of its maker",
}
_MASKS = (0xFFFF, 0xFFF0, 0xFF00, 0xF000)


def group_of(code: int) -> int:
    """The code under which a code is in the table: itself, or its group; 0 if it has none."""
    return next((code & mask for mask in _MASKS if code & mask in _TEXTS), 0)


def fault_text(code: int) -> str:
    """What an error code means: its own text, or that of its group; "" if it has none."""
    return _TEXTS.get(group_of(code), "")
