"""Inputs and outputs of the machine by the numbers of the store: inversion, and none at all."""

from openacr.mill.machine import Look, Machine
from openacr.mill.settings import Settings

FIRST_OUTPUT, BEHIND_OUTPUTS = 32, 64
INPUTS = 32


class Panel:
    """What is wired to the card, and what was switched last."""

    def __init__(self, machine: Machine, settings: Settings) -> None:
        self.machine = machine
        self.settings = settings
        self._out: dict[int, bool] = {}
        self._inverted_in = {n for n in range(INPUTS) if settings.is_input_inverted(n)}

    def output(self, number: int, on: bool) -> None:
        """Switch an output; a number that is none does nothing."""
        if not FIRST_OUTPUT <= number < BEHIND_OUTPUTS:
            return
        self._out[number] = on
        self.machine.set_flag(number, on != self.settings.is_output_inverted(number))

    def is_out(self, number: int) -> bool:
        """Whether an output was switched on here."""
        return self._out.get(number, False)

    def has_input(self, number: int) -> bool:
        """Whether there is an input of this number."""
        return 0 <= number < INPUTS

    def is_in(self, look: Look, number: int) -> bool:
        """Whether an input is active; one that is not there is not."""
        return self.has_input(number) and look.input(number) != (number in self._inverted_in)
