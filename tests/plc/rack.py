"""PLCs on a bare memory, interrupt by interrupt."""

from collections.abc import Callable
from typing import Any

from openacr.compiled import pick
from openacr.lang.lexer import tokens
from openacr.map.memory import Memory
from openacr.map.rows import system
from openacr.plc.control import Plcs
from openacr.plc.reader import PlcLine, read_line
from openacr.plc.scan_cy import plc_step


class Names:
    """Aliases by number; ACC is a word of AcroBASIC."""

    known: dict[str, int] = {"Lamp": 33, "Ten": 10, "Far": 9000}  # noqa: RUF012

    def number(self, name: str) -> int | None:
        return self.known.get(name)

    def is_command(self, word: str) -> bool:
        return word == "ACC"


def read(text: str) -> PlcLine | None:
    return read_line(tokens(text), Names())


def numbered(*lines: str) -> list[tuple[int, PlcLine]]:
    """Lines with the numbers 10, 20, ..."""
    read_lines = (read(line) for line in lines)
    return [(10 * place, line) for place, line in enumerate(read_lines, 1) if line is not None]


class Rack:
    """`program` stores and runs, `step` lets interrupts pass."""

    def __init__(self, step: Callable[..., Any] | None = None) -> None:
        self.memory = Memory()
        self.memory.F[system.period_s] = 0.0005
        self.texts: dict[int, list[tuple[int, PlcLine]]] = {}
        self.plcs = Plcs(self.memory, lambda plc: self.texts.get(plc, []))
        self._step = step or pick(plc_step)

    def program(self, *lines: str, plc: int = 0) -> "Rack":
        self.texts[plc] = numbered(*lines)
        self.plcs.run(plc)
        return self

    def step(self, ticks: int = 1) -> None:
        for _ in range(ticks):
            self._step(self.memory.F, self.memory.I)

    def put(self, on: bool, *bits: int) -> None:
        for bit in bits:
            self.memory.set_bit(bit, on)

    def on(self, bit: int) -> bool:
        return self.memory.bit(bit)

    def after(self, inputs: int, output: int = 32, count: int = 4) -> bool:
        """State of a flag after a scan with inputs 0 to 3 as the bits of `inputs`."""
        for bit in range(count):
            self.memory.set_bit(bit, bool(inputs >> bit & 1))
        self.step()
        return self.on(output)

    def p(self, number: int) -> int:
        return int(self.memory.read(number))

    def write(self, number: int, value: int) -> None:
        self.memory.write(number, value)
