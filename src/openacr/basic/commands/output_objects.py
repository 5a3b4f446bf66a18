"""Global objects: ratchets, limiters, programmable limit switches, output objects."""

from __future__ import annotations

from functools import partial

from openacr.basic.commands.follower_forms import ArrayName, choose_object_source
from openacr.basic.commands.value_commands import ObjectValue, check_number, object_values
from openacr.basic.language import registry
from openacr.basic.language.grammar import (
    Bit,
    BitState,
    Group,
    Num,
    ObjectRef,
    ParameterName,
    SignedParameter,
    Source,
)
from openacr.basic.language.number_format import NumberKind, number_text
from openacr.basic.language.registry import ANY
from openacr.basic.vm.run import Run, whole
from openacr.errors import CardError
from openacr.kernel.followers.cam_cy import LONGS
from openacr.kernel.sources.source_cy import LIMITER_TAPS, OUTPUT_TAPS, RATCHET_TAPS, SWITCH_TAPS
from openacr.map import numbers as at
from openacr.map.kinds_cy import kind_of
from openacr.map.memory import Memory
from openacr.map.rows import limit_switches, limiters, output_objects, ratchets
from openacr.messages import INVALID_BIT, INVALID_PARAMETER
from openacr.motion.axis.settings import fp64, long, not_negative, not_zero
from openacr.motion.card import Card
from openacr.motion.followers import cam, objects
from openacr.motion.sources import sources

GROUP = "Global Objects"
REF = "PG Global Objects"
command = partial(registry.command, group=GROUP, ref=REF)
HIGHEST_MODE = 15
FIRST_SWITCH_FLAG = 120


def eight(card: Card) -> int:
    """How many ratchets, limiters, limit switches and output objects there are."""
    return ratchets.COUNT


def mode(value: float) -> bool:
    """A ratchet mode: 4 * treatment of positive + treatment of negative counts."""
    return 0 <= value <= HIGHEST_MODE and value == int(value)


object_values(
    (
        ObjectValue("RATCH # MODE", long(ratchets.mode, mode),
                    eight, "Choose what a ratchet does with positive and negative counts."),
        ObjectValue("LIMIT # FREQ", fp64(limiters.freq_hz, not_negative),
                    eight, "Set the highest rate of a limiter; 0 is no limit.", "pulses/s"),
        ObjectValue("LIMIT # MULT", fp64(limiters.mult),
                    eight, "Multiply the counts of a limiter.", "", "1"),
        ObjectValue("PLS # MASK", long(limit_switches.mask),
                    eight, "Set the bits a limit switch writes.", "", "-1"),
        ObjectValue("PLS # RATIO", fp64(limit_switches.ratio, not_zero),
                    eight, "Set the array elements per source pulse of a limit switch.", "", "1"),
        ObjectValue("PLS # ROTARY", fp64(limit_switches.rotary, not_negative),
                    eight, "Set the elements after which a limit switch begins again; 0 is never."),
        ObjectValue("PLS # FLZ", fp64(limit_switches.flz_cnt),
                    eight, "Shift the source of a limit switch.", "pulses"),
    ),
    group=GROUP,
    ref=REF,
)  # fmt: skip


# ratchets and limiters


@command("RATCH # SRC", levels=ANY, grammar=(Source(optional=True),), default="NONE")
def ratch_src(run: Run, number: int, source: ObjectRef | None) -> None:
    """Choose the source of a ratchet."""
    check_number(number, ratchets.COUNT)
    choose_object_source(run, RATCHET_TAPS + number, source)


@command("RATCH # RES", levels=ANY, grammar=(Num("value", optional=True),), units="pulses")
def ratch_res(run: Run, number: int, value: float | None) -> None:
    """Set the output of a ratchet (0) and forget what it has buffered."""
    check_number(number, ratchets.COUNT)
    objects.reset_ratchet(run.card, number, value or 0.0)


@command("RATCH #", levels=ANY, units="pulses")
def ratch_report(run: Run, number: int) -> None:
    """Report the output of a ratchet."""
    _print_row(run, number, ratchets.output_cnt)


@command("LIMIT # SRC", levels=ANY, grammar=(Source(optional=True),), default="NONE")
def limit_src(run: Run, number: int, source: ObjectRef | None) -> None:
    """Choose the source of a limiter."""
    check_number(number, limiters.COUNT)
    choose_object_source(run, LIMITER_TAPS + number, source)


@command("LIMIT # RES", levels=ANY, grammar=(Num("value", optional=True),), units="pulses")
def limit_res(run: Run, number: int, value: float | None) -> None:
    """Set the output of a limiter (0) and forget what it has held back."""
    check_number(number, limiters.COUNT)
    objects.reset_limiter(run.card, number, value or 0.0)


@command("LIMIT #", levels=ANY, units="pulses")
def limit_report(run: Run, number: int) -> None:
    """Report the output of a limiter."""
    _print_row(run, number, limiters.output_cnt)


def _print_row(run: Run, number: int, row: tuple[int, ...]) -> None:
    check_number(number, len(row))
    run.print(number_text(run.card.memory.F[row[number]], NumberKind.DOUBLE))


# programmable limit switches


@command("PLS # SRC", levels=ANY, grammar=(Source(optional=True),), default="NONE")
def pls_src(run: Run, number: int, source: ObjectRef | None) -> None:
    """Choose the position a limit switch looks at."""
    check_number(number, limit_switches.COUNT)
    choose_object_source(run, SWITCH_TAPS + number, source)


@command("PLS # BASE", levels=ANY, grammar=(ArrayName("LA"),))
def pls_base(run: Run, number: int, array: ObjectRef) -> None:
    """Choose the array of output patterns of a limit switch."""
    check_number(number, limit_switches.COUNT)
    program = run.needed_program()
    cam.array_length(run.card, program, LONGS, array.number, 1)
    run.card.memory.I[limit_switches.program[number]] = program
    run.card.memory.I[limit_switches.array[number]] = array.number + 1


@command("PLS # DST", levels=ANY, grammar=(ParameterName(optional=True),), default="P4097")
def pls_dst(run: Run, number: int, parameter: SignedParameter | None) -> None:
    """Choose the LONG parameter a limit switch writes to."""
    check_number(number, limit_switches.COUNT)
    row = limit_switches.destination[number]
    if parameter is None:
        run.print(f"P{run.card.memory.I[row]}")
    elif kind_of(run.card.memory.I, parameter.number) != at.KIND_LONG:
        raise CardError(INVALID_PARAMETER)
    else:
        run.card.memory.I[row] = parameter.number


@command("PLS # RES", levels=ANY, grammar=(Num("index", optional=True),))
def pls_res(run: Run, number: int, index: float | None) -> None:
    """Make the present position of the source this index (0) of the array."""
    check_number(number, limit_switches.COUNT)
    memory = run.card.memory
    now = sources.value(run.card, SWITCH_TAPS + number)
    offset = (index or 0.0) / memory.F[limit_switches.ratio[number]]
    memory.F[limit_switches.base_cnt[number]] = (
        now + memory.F[limit_switches.flz_cnt[number]] - offset
    )


@command("PLS # ON", levels=ANY)
def pls_on(run: Run, number: int) -> None:
    """Switch a limit switch on; it writes nothing before BASE has given it an array."""
    check_number(number, limit_switches.COUNT)
    sources.objects_go_live(run.card)
    run.card.memory.set_bit(FIRST_SWITCH_FLAG + number, True)


@command("PLS # OFF", levels=ANY)
def pls_off(run: Run, number: int) -> None:
    """Switch a limit switch off; its outputs stay."""
    check_number(number, limit_switches.COUNT)
    run.card.memory.set_bit(FIRST_SWITCH_FLAG + number, False)


@command("PLS #", levels=ANY)
def pls_report(run: Run, number: int) -> None:
    """Report source, array, destination and state of a limit switch."""
    check_number(number, limit_switches.COUNT)
    memory = run.card.memory
    array = memory.I[limit_switches.array[number]] - 1
    base = "NONE" if array < 0 else f"LA{array}"
    on = "ON" if memory.bit(FIRST_SWITCH_FLAG + number) else "OFF"
    source = sources.text(run.card, SWITCH_TAPS + number)
    destination = memory.I[limit_switches.destination[number]]
    run.print(f"PLS{number} {on} SRC {source} BASE {base} DST P{destination}")


# output objects


@command(
    "OOP # SRC", levels=ANY, grammar=(Source(optional=True),), default="ENC of the same number"
)
def oop_src(run: Run, number: int, source: ObjectRef | None) -> None:
    """Choose the position an output object looks at."""
    check_number(number, output_objects.COUNT)
    choose_object_source(run, OUTPUT_TAPS + number, source)


@command("OOP # BIT", levels=ANY, grammar=(Bit(optional=True),), default="32 + number")
def oop_bit(run: Run, number: int, bit: BitState | None) -> None:
    """Choose the flag of an output object."""
    check_number(number, output_objects.COUNT)
    row = output_objects.bit[number]
    if bit is None:
        run.print(str(run.card.memory.I[row]))
    elif not 0 <= bit.number <= at.FLAG_LAST:
        raise CardError(INVALID_BIT)
    else:
        run.card.memory.I[row] = bit.number


@command("OOP # POS", levels=ANY, grammar=(Group("from", "to"),), units="pulses")
def oop_pos(run: Run, number: int, window: tuple[float, float]) -> None:
    """Set the window in which the flag of an output object is set."""
    check_number(number, output_objects.COUNT)
    objects.set_window(run.card, number, *window)


@command(
    "OOP # INC",
    levels=ANY,
    units="pulses",
    grammar=(Group("start", "pitch", "width", "count", fewest=3),),
)
def oop_inc(run: Run, number: int, windows: tuple[float, ...]) -> None:
    """Set repeating windows of an output object; without a count they are endless."""
    check_number(number, output_objects.COUNT)
    start, pitch, width = windows[:3]
    objects.set_windows(run.card, number, start, pitch, width, whole((*windows, 0.0)[3]))


@command("OOP # ON", levels=ANY)
def oop_on(run: Run, number: int) -> None:
    """Switch an output object on."""
    check_number(number, output_objects.COUNT)
    objects.output_on(run.card, number, True)


@command("OOP # OFF", levels=ANY)
def oop_off(run: Run, number: int) -> None:
    """Switch an output object off; its flag is cleared."""
    check_number(number, output_objects.COUNT)
    objects.output_on(run.card, number, False)


@command("OOP #", levels=ANY)
def oop_report(run: Run, number: int) -> None:
    """Report source, flag, windows and state of an output object."""
    check_number(number, output_objects.COUNT)
    memory = run.card.memory
    on = "ON" if memory.I[output_objects.on[number]] else "OFF"
    source = sources.text(run.card, OUTPUT_TAPS + number)
    window = ",".join(
        number_text(memory.F[row[number]], NumberKind.DOUBLE)
        for row in (output_objects.from_cnt, output_objects.to_cnt)
    )
    windows = _windows_text(memory, number)
    flag = memory.I[output_objects.bit[number]]
    run.print(f"OOP{number} {on} SRC {source} BIT {flag} POS ({window}){windows}")


def _windows_text(memory: Memory, number: int) -> str:
    """The windows of INC as they are typed; nothing before any are set."""
    if not memory.F[output_objects.pitch_cnt[number]]:
        return ""
    rows = output_objects.start_cnt, output_objects.pitch_cnt, output_objects.width_cnt
    texts = [number_text(memory.F[row[number]], NumberKind.DOUBLE) for row in rows]
    count = memory.I[output_objects.windows[number]]
    return f" INC ({','.join([*texts, str(count)] if count else texts)})"
