"""Global objects: the fast status block (FSTAT), copies of parameters for a host on the bus.

The virtual card has no bus to a PC: the copies are kept as the card would hand them over, and
`FSTAT n` shows them.
"""

from __future__ import annotations

from functools import partial

from openacr.basic.commands.value_commands import check_number
from openacr.basic.language import registry
from openacr.basic.language.grammar import Group, Int
from openacr.basic.language.number_format import NumberKind, number_text
from openacr.basic.language.registry import ANY
from openacr.basic.vm.run import Run, whole
from openacr.errors import CardError
from openacr.map import numbers as at
from openacr.map.kinds_cy import kind_of
from openacr.map.lookup import packet_groups
from openacr.map.rows import fast_status
from openacr.map.words import fsf
from openacr.messages import INVALID_ARGUMENT

GROUP = "Global Objects"
REF = "PG Global Objects"
command = partial(registry.command, group=GROUP, ref=REF)
FIELDS = 8
TYPES = (LONG, FP32) = (0, 1)
LONGEST_MS = 60000


@command("FSTAT ON", levels=ANY)
def fstat_on(run: Run) -> None:
    """Load the entries of the fast status block and copy it cyclically."""
    run.card.memory.I[at.W_FSTAT] |= fsf.FSTAT_ON_REQUEST


@command("FSTAT OFF", levels=ANY)
def fstat_off(run: Run) -> None:
    """Stop copying: the fast status block stays as it is."""
    run.card.memory.I[at.W_FSTAT] &= ~(fsf.FSTAT_ON | fsf.FSTAT_ON_REQUEST)


@command(
    "FSTAT PERIOD",
    levels=ANY,
    units="ms",
    default="50",
    grammar=(Int("ms", 1, LONGEST_MS, optional=True),),
)
def fstat_period(run: Run, period_ms: int | None) -> None:
    """Set the time from copy to copy."""
    if period_ms is None:
        run.print(str(run.card.memory.I[at.P_FSTAT_PERIOD]))
    else:
        run.card.memory.I[at.P_FSTAT_PERIOD] = period_ms


@command("FSTAT CLEAR", levels=ANY)
def fstat_clear(run: Run) -> None:
    """Forget all entries of the fast status block."""
    for number in range(fast_status.COUNT):
        _write(run, number, 0, 0, LONG)


@command("FSTAT #", levels=ANY, grammar=(Group("code", "index", "type", fewest=2, optional=True),))
def fstat_entry(run: Run, number: int, chosen: tuple[float, ...] | None) -> None:
    """Choose the packet group an entry copies, or show its copy.

    The type of the copy, LONG (0) or FP32 (1), is that of the group unless it is given.
    """
    check_number(number, fast_status.COUNT)
    if chosen is None:
        run.print(",".join(_copies(run, number)))
        return
    code, index, *types = map(whole, chosen)
    numbers = packet_groups().get((code, index))
    if numbers is None:
        raise CardError(INVALID_ARGUMENT)
    kind = types[0] if types else _type_of(run, numbers)
    if kind not in TYPES:
        raise CardError(INVALID_ARGUMENT)
    _write(run, number, code, index, kind)


def _type_of(run: Run, numbers: tuple[int | None, ...]) -> int:
    first = next(number for number in numbers if number is not None)
    return FP32 if kind_of(run.card.memory.I, first) == at.KIND_FP32 else LONG


def _write(run: Run, number: int, code: int, index: int, kind: int) -> None:
    memory = run.card.memory.I
    memory[fast_status.fstat_code[number]] = code
    memory[fast_status.fstat_index[number]] = index
    memory[fast_status.fstat_type[number]] = kind


def _copies(run: Run, number: int) -> list[str]:
    memory, first = run.card.memory, fast_status.words[number]
    words = range(first, first + FIELDS)
    if memory.I[fast_status.type[number]] == FP32:
        return [number_text(memory.S[word], NumberKind.SINGLE) for word in words]
    return [str(memory.I[word]) for word in words]


@command("FSTAT", levels=ANY)
def fstat_report(run: Run) -> None:
    """Report state, period and entries of the fast status block."""
    memory = run.card.memory.I
    is_on = memory[at.W_FSTAT] & (fsf.FSTAT_ON | fsf.FSTAT_ON_REQUEST)
    run.print(f"FSTAT {'ON' if is_on else 'OFF'} PERIOD {memory[at.P_FSTAT_PERIOD]}")
    for number in range(fast_status.COUNT):
        rows = fast_status.fstat_code, fast_status.fstat_index, fast_status.fstat_type
        code, index, kind = (memory[row[number]] for row in rows)
        if code:
            run.print(f"FSTAT{number} ({code},{index},{kind})")
