"""A first `machine.toml` of the devices that a scan has found."""

from collections.abc import Iterator

from openacr.fieldbus.ethercat.master import mapping
from openacr.fieldbus.ethercat.master.device import Device

AXES = 16
FIRST_OUTPUT = 32
ADCS = 8
CHANNELS = 32  # inputs of the card, and outputs
NAMES = "XYZABCUV"
COUNTS_PER_REV = 4000


def machine_file(interface: str, devices: list[Device]) -> str:
    """The text of the file: an axis for each drive, its numbers for each terminal."""
    return "\n".join(_lines(interface, devices)) + "\n"


def _lines(interface: str, devices: list[Device]) -> Iterator[str]:
    yield "# What `openacr bus scan` has found. Look at every line with the word: check."
    yield "[bus]"
    yield f'interface = "{interface}"'
    yield "cycle = 2  # servo periods between two frames"
    yield "dc = true  # one clock for all drives"
    yield from _terminals([device for device in devices if not device.is_drive])
    drives = [device for device in devices if device.is_drive]
    for number, device in enumerate(drives[:AXES]):
        yield ""
        yield from _axis(number, device)
    for device in drives[AXES:]:
        yield f"# {device.label}: a card has {AXES} axes"


def _terminals(devices: list[Device]) -> Iterator[str]:
    used_in = used_out = used_adcs = 0
    for device in devices:
        inputs = mapping.of_pdos(device.description.transmit)
        outputs = mapping.of_pdos(device.description.receive)
        ins, outs = len(inputs.contacts), len(outputs.contacts)
        if inputs.words or outputs.words:
            yield from _analog(device, len(inputs.words), len(outputs.words), used_adcs)
            used_adcs += len(inputs.words)
            continue
        if not ins and not outs:
            yield f"# {device.label}: it has no channels"
            continue
        if used_in + ins > CHANNELS or used_out + outs > CHANNELS:
            yield f"# {device.label}: the card has {CHANNELS} inputs and {CHANNELS} outputs"
            continue
        yield ""
        yield "[[bus.terminal]]"
        yield from _identity(device)
        if ins:
            yield f"inputs_from = {used_in}  # check: the first input of the card"
            yield f"inputs = {ins}"
        if outs:
            yield f"outputs_from = {FIRST_OUTPUT + used_out}  # check: the first output of the card"
            yield f"outputs = {outs}"
        used_in, used_out = used_in + ins, used_out + outs


def _analog(device: Device, ins: int, outs: int, used: int) -> Iterator[str]:
    if used + ins > ADCS:
        yield f"# {device.label}: the card has {ADCS} analog inputs"
        return
    yield ""
    yield "[[bus.terminal]]"
    yield from _identity(device)
    if ins:
        yield f"adcs_from = {used}  # check: the first analog input of the card"
        yield f"adcs = {ins}"
    if outs:
        yield f"# dacs_from = 8  # check: {outs} analog outputs, from the first that no axis has"
        yield f"# dacs = {outs}"
    yield "full_v = 10.0  # check: volts at 32767"


def _axis(number: int, device: Device) -> Iterator[str]:
    yield "[[axis]]"
    yield f"number = {number}"
    yield f'name = "{NAMES[number] if number < len(NAMES) else f"AX{number}"}"'
    yield f"counts_per_rev = {COUNTS_PER_REV}  # check: counts of the card in a revolution"
    yield 'drive = { mode = "exact" }  # of runs without the bus'
    yield ""
    yield "[axis.bus]"
    yield from _identity(device)
    yield 'mode = "csp"  # the drive closes the loop; csv and cst need per_volt'
    yield f"counts_per_rev = {COUNTS_PER_REV}  # check: counts of the drive in a revolution"
    yield 'direction = "up"  # check: "down" if the drive counts against the card'
    yield "# inputs = { positive_limit = 0, negative_limit = 1, home = 2 }  # of the drive itself"


def _identity(device: Device) -> Iterator[str]:
    who = device.description.identity
    yield f"position = {device.position}  # {device.description.name or 'a device without a name'}"
    yield f"vendor = 0x{who.vendor:X}"
    yield f"product = 0x{who.product:X}"
