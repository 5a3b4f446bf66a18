"""Global objects: the sampler."""

from __future__ import annotations

from functools import partial

from openacr.basic.commands.follower_forms import ArrayName, needs_parameter
from openacr.basic.commands.value_commands import check_number
from openacr.basic.language import registry
from openacr.basic.language.grammar import (
    Bit,
    BitState,
    Num,
    ObjectRef,
    ParameterName,
    SignedParameter,
)
from openacr.basic.language.number_format import NumberKind, number_text
from openacr.basic.language.registry import ANY
from openacr.basic.vm.run import Run
from openacr.errors import CardError
from openacr.kernel.followers.cam_cy import DOUBLES, LONGS, SINGLES
from openacr.kernel.status.sample_cy import INTO_DOUBLE, INTO_LONG, INTO_SINGLE
from openacr.map import numbers as at
from openacr.map.rows import sampler
from openacr.map.words import mo
from openacr.messages import INVALID_ARGUMENT, INVALID_BIT
from openacr.motion.followers import cam

GROUP = "Global Objects"
REF = "PG Global Objects"
command = partial(registry.command, group=GROUP, ref=REF)
CHANNELS = sampler.SOURCE_SIZE
MS_PER_S = 1000.0
LONGEST_S = 2e6

# Kind of array: its number in the kernel, its table of references, words per element.
_ARRAYS = {
    "LA": (INTO_LONG, LONGS, 1),
    "SA": (INTO_SINGLE, SINGLES, 1),
    "DA": (INTO_DOUBLE, DOUBLES, 2),
}
_WORDS = {row[0]: word for word, row in _ARRAYS.items()}


@command("SAMP # SRC", levels=ANY, grammar=(ParameterName(),))
def samp_src(run: Run, channel: int, parameter: SignedParameter) -> None:
    """Choose the parameter a channel records."""
    check_number(channel, CHANNELS)
    needs_parameter(run, parameter.number)
    run.card.memory.I[sampler.source + channel] = parameter.number + 1


@command("SAMP # BASE", levels=ANY, grammar=(ArrayName("LA", "SA", "DA"),))
def samp_base(run: Run, channel: int, array: ObjectRef) -> None:
    """Choose the array a channel records into."""
    check_number(channel, CHANNELS)
    program = run.needed_program()
    kind, table, words = _ARRAYS[array.word]
    cam.array_length(run.card, program, table, array.number, words)
    memory = run.card.memory
    memory.I[sampler.kind + channel] = kind
    memory.I[sampler.program + channel] = program
    memory.I[sampler.array + channel] = array.number


@command("SAMP TRG", levels=ANY, grammar=(Bit(signed=True),))
def samp_trg(run: Run, bit: BitState) -> None:
    """Choose the flag, and its state, that starts sampling."""
    if not 0 <= bit.number <= at.FLAG_LAST:
        raise CardError(INVALID_BIT)
    run.card.memory.I[sampler.trigger] = bit.number + 1
    run.card.memory.I[sampler.trigger_clear] = int(bit.clear)


@command("SAMP PERIOD", levels=ANY, grammar=(Num("period", optional=True),), units="s")
def samp_period(run: Run, period_s: float | None) -> None:
    """Set the time from sample to sample; 0 is every servo period."""
    if period_s is None:
        every_s = run.card.memory.I[at.P_SAMPLE_TIMER_PERIOD] / MS_PER_S
        run.print(number_text(every_s, NumberKind.DOUBLE))
    elif not 0.0 <= period_s <= LONGEST_S:
        raise CardError(INVALID_ARGUMENT)
    else:
        run.card.memory.I[at.P_SAMPLE_TIMER_PERIOD] = round(period_s * MS_PER_S)


@command("SAMP CLEAR", levels=ANY)
def samp_clear(run: Run) -> None:
    """Stop sampling and forget channels, trigger and period."""
    memory = run.card.memory
    flags = mo.SAMPLE_TRIGGER_ARMED | mo.SAMPLE_IN_PROGRESS | mo.SAMPLE_TRIGGER_LATCHED
    memory.I[at.W_MISC_OUTPUTS] &= ~flags
    for offset in range(sampler.INTS_SIZE):
        memory.I[sampler.ints + offset] = 0
    for row in (at.P_SAMPLE_ARRAY_INDEX, at.P_SAMPLE_TRIGGER_INDEX, at.P_SAMPLE_TIMER_PERIOD):
        memory.I[row] = 0


@command("SAMP", levels=ANY)
def samp_report(run: Run) -> None:
    """Report trigger, period and channels of the sampler."""
    rows = run.card.memory.I
    trigger = rows[sampler.trigger] - 1
    if trigger >= 0:
        sign = "-" if rows[sampler.trigger_clear] else ""
        run.print(f"SAMP TRG {sign}BIT{trigger}")
    every_s = number_text(rows[at.P_SAMPLE_TIMER_PERIOD] / MS_PER_S, NumberKind.DOUBLE)
    run.print(f"SAMP PERIOD {every_s}")
    for channel in range(CHANNELS):
        source = rows[sampler.source + channel] - 1
        kind = rows[sampler.kind + channel]
        if source >= 0:
            run.print(f"SAMP {channel} SRC P{source}")
        if kind:
            array = rows[sampler.array + channel]
            run.print(f"SAMP {channel} BASE {_WORDS[kind]}{array}")
