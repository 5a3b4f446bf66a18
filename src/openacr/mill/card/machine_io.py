"""Inputs and outputs of the machine by their numbers in the store, with inversion.

A number is that of the flag on the card: 0 to 31 and 32 to 63 on the card itself, 256 to 287
and 288 to 319 on the first expansion module, 64 more on each further one.
"""

from openacr.mill.card.driver import CardState, MachineDriver
from openacr.mill.config.settings import Settings

FIRST_OUTPUT, END_OUTPUTS = 32, 64
FIRST_EXPANSION, EXPANSION_FLAGS = 256, 64  # of each module: 32 inputs, then 32 outputs


class MachineIo:
    """Inputs and outputs of one machine, with the last commanded state of each output."""

    def __init__(self, machine: MachineDriver, settings: Settings) -> None:
        self.machine = machine
        self.settings = settings
        self._out: dict[int, bool] = {}
        modules = settings.io_modules
        machine.watch_modules(modules)
        inputs, outputs = line_numbers(settings.model.lines, modules)
        self.inputs, self.outputs = frozenset(inputs), frozenset(outputs)
        self._inverted_in = {n for n in self.inputs if settings.is_input_inverted(n)}
        self._pressed: set[int] = set()

    def output(self, number: int, on: bool) -> None:
        """Switch an output; a number that is not configured is ignored."""
        if number not in self.outputs:
            return
        self._out[number] = on
        self.machine.set_flag(number, on != self.settings.is_output_inverted(number))

    def renew(self) -> None:
        """Send the last commanded state of every output again."""
        for number, on in self._out.items():
            self.output(number, on)

    def safe_levels(self) -> list[tuple[int, bool]]:
        """The outputs of spindle, coolant and beam, with their levels when switched off."""
        row, burning = self.settings.spindle, self.settings.burning
        ons = (row.cw, row.ccw, row.mist, row.flood, burning.plasma, burning.under_burn)
        off = [(number, False) for number in ons] + [(row.off, True), (row.coolant_off, True)]
        return [
            (number, on != self.settings.is_output_inverted(number))
            for number, on in off
            if number in self.outputs
        ]

    def is_on(self, number: int) -> bool:
        """Whether an output is active on the card."""
        bit = self.machine.card.read_bit(number)
        return bit != self.settings.is_output_inverted(number)

    def is_out(self, number: int) -> bool:
        """Whether an output was last commanded on."""
        return self._out.get(number, False)

    def has_input(self, number: int) -> bool:
        """Whether this input exists."""
        return number in self.inputs

    def is_inverted(self, number: int) -> bool:
        """Whether an input is active when it is off."""
        return number in self._inverted_in

    def press(self, number: int, on: bool) -> None:
        """Hold an input active from a screen, as its switch does; False lets it go."""
        if on:
            self._pressed.add(number)
        else:
            self._pressed.discard(number)

    def is_pressed(self, number: int) -> bool:
        """Whether a screen holds an input active."""
        return number in self._pressed

    def is_in(self, sample: CardState, number: int) -> bool:
        """Whether an input is active, or held by a screen; False if it does not exist."""
        if number in self._pressed:
            return True
        return self.has_input(number) and sample.input(number) != (number in self._inverted_in)

    def is_key_turned(self, sample: CardState) -> bool:
        """Whether the maintenance key is turned: its input is off then."""
        number = self.settings.wiring.soft_limits
        return self.has_input(number) and not self.is_in(sample, number)


def line_numbers(lines: int, modules: int) -> tuple[list[int], list[int]]:
    """Inputs and outputs of a card with `lines` of each, and of its expansion modules."""
    begins = [FIRST_EXPANSION + EXPANSION_FLAGS * module for module in range(modules)]
    half = EXPANSION_FLAGS // 2
    inputs = [*range(lines), *(n for begin in begins for n in range(begin, begin + half))]
    outputs = [n for begin in begins for n in range(begin + half, begin + EXPANSION_FLAGS)]
    return inputs, [*range(FIRST_OUTPUT, FIRST_OUTPUT + lines), *outputs]
