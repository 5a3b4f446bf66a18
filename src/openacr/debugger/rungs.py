"""Lines of PLCs as breakpoints: what a line drives, and the operands it is seen with.

The scan of a PLC is one step of a servo interrupt; no line of it is a moment. What can be seen
from outside is that a coil has changed.
"""

from __future__ import annotations

from collections.abc import Iterator

from openacr.client.program_variables import Value
from openacr.controller.controller import Controller
from openacr.plc.instructions import Operand, output_flag
from openacr.plc.reader import PlcLine, Step

NO_COIL = "no coil of a PLC on this line: a breakpoint stops after the scan in which one changes"


def coils(card: Controller, plc: int, line: int) -> list[int]:
    """The flags that a line of a PLC (16-23) drives; of a timer, counter or latch its output."""
    steps = _steps(card, plc, line)
    return list(dict.fromkeys(_flag(step) for step in steps if step.instruction.is_output))


def operands(card: Controller, plc: int, line: int) -> Iterator[Value]:
    """The flags that a line of a PLC reads or drives, as they are now."""
    steps = _steps(card, plc, line)
    found = (_flag(step) for step in steps if step.instruction.operand is not Operand.NONE)
    for flag in dict.fromkeys(found):
        yield Value(f"BIT{flag}", str(int(card.bit[flag])))


def states(card: Controller, flags: list[int]) -> str:
    """Which of these flags are set, as a sentence: `BIT41 is set, BIT42 is clear`."""
    return ", ".join(f"BIT{flag} is {'set' if card.bit[flag] else 'clear'}" for flag in flags)


def _steps(card: Controller, plc: int, line: int) -> tuple[Step, ...]:
    for stored in card.system.programs.lines(plc):
        if stored.number == line:
            tree: PlcLine = stored.tree
            return tree.steps
    return ()


def _flag(step: Step) -> int:
    operand = step.instruction.operand
    return step.number if operand is Operand.FLAG else output_flag(operand, step.number)
