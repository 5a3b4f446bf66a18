"""Terminals: digital and analog inputs and outputs."""

from openacr.fieldbus.ethercat.emulated.dictionary import INPUT, OUTPUT, Entry
from openacr.fieldbus.ethercat.emulated.pdo import gap
from openacr.fieldbus.ethercat.emulated.slave import VENDOR, Slave, describe
from openacr.fieldbus.ethercat.wire import sii
from openacr.fieldbus.ethercat.wire.data_types import DataType
from openacr.fieldbus.ethercat.wire.registers import AlCode

DIGITAL_PRODUCT, ANALOG_PRODUCT = 0x0D10, 0x0A10
FULL_SCALE = 32767  # of 10 V
VOLTS = 10.0
_IN, _OUT = 0x6000, 0x7000


def _channels(index: int, count: int, bits: int, kind: DataType, text: str) -> sii.Pdo:
    entries = [
        sii.Entry(index + 0x10 * (n // 16), n % 16 + 1, bits, f"{text} {n + 1}", kind)
        for n in range(count)
    ]
    if spare := -count * bits % 8:
        entries.append(gap(spare))
    is_out = index >= _OUT
    return sii.Pdo(0x1600 if is_out else 0x1A00, tuple(entries), 2 + (not is_out), text, True)


class Terminal(Slave):
    """Channels of one kind; `inputs` are set from outside, `outputs` are what the master set."""

    def __init__(
        self, product: int, kind: DataType, bits: int, inputs: int, outputs: int, name: str
    ) -> None:
        receive = (_channels(_OUT, outputs, bits, kind, "Output"),) if outputs else ()
        transmit = (_channels(_IN, inputs, bits, kind, "Input"),) if inputs else ()
        self._kind = kind
        self._shape = inputs, outputs
        self._ins: list[Entry] = []
        self._outs: list[Entry] = []
        code = product << 16 | inputs << 8 | outputs
        super().__init__(describe(sii.Identity(VENDOR, code, 1), name, receive, transmit), name)

    def add_objects(self) -> None:
        """The channels: inputs from 0x6000 on, outputs from 0x7000 on."""
        for first, count, access, into, text in (
            (_IN, self._shape[0], INPUT, self._ins, "Input"),
            (_OUT, self._shape[1], OUTPUT, self._outs, "Output"),
        ):
            into += [Entry(f"{text} {n + 1}", self._kind, access) for n in range(count)]
            for start in range(0, count, 16):
                index = first + start
                self.dictionary.add_record(index, f"{text}s", into[start : start + 16])

    def outputs_off(self, code: AlCode) -> None:
        """All outputs are off."""
        for entry in self._outs:
            entry.value = 0

    def _input(self, channel: int) -> Entry:
        return self._ins[channel]


class Digital(Terminal):
    """Digital channels, a bit each."""

    def __init__(self, inputs: int, outputs: int, name: str = "digital") -> None:
        super().__init__(DIGITAL_PRODUCT, DataType.BOOLEAN, 1, inputs, outputs, name)

    def set_input(self, channel: int, on: bool) -> None:
        """Set the level of an input, counted from 0."""
        self._input(channel).value = int(on)

    @property
    def outputs(self) -> list[bool]:
        """The levels of the outputs."""
        return [bool(entry.value) for entry in self._outs]


class Analog(Terminal):
    """Analog channels of 10 V, 16 bits each."""

    def __init__(self, inputs: int, outputs: int, name: str = "analog") -> None:
        super().__init__(ANALOG_PRODUCT, DataType.INTEGER16, 16, inputs, outputs, name)

    def set_input(self, channel: int, volts: float) -> None:
        """Set the voltage at an input, counted from 0; beyond 10 V it stays at its end."""
        value = round(volts / VOLTS * FULL_SCALE)
        self._input(channel).value = max(-FULL_SCALE - 1, min(FULL_SCALE, value))

    @property
    def outputs(self) -> list[float]:
        """The voltages at the outputs."""
        return [entry.number * VOLTS / FULL_SCALE for entry in self._outs]
