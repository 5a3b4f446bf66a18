"""The set-up file: memory, hardware, axes and masters, in the order a card needs them."""

import re
import struct
from collections.abc import Iterator

from openacr.basic.memory.memory_cost import BUFFERED_MOVE
from openacr.configure.answers import Answers, AxisAnswers, MasterAnswers

PROGRAM_BYTES = (8192, 4096, *[1000] * 13, 28672)  # PROG0 to PROG15
WATCH_PROGRAM, WATCH_BYTES = 7, 28672
PLC_BYTES = 4096
FIRST_PLC = 5  # of those that watch the limits
USER_PARAMETERS, WATCHED_PARAMETERS = 100, 201
DEFINES = 20
SOFT_POSITIVE, SOFT_NEGATIVE = 100, 116  # P100-P115, P116-P131: limits by axis
DAC_GAIN = "3276.8"
FLAGS_PER_AXIS = 32

# Where the card keeps answers: parameters of the network, flags of axis 0, words of a master.
CANOPEN_PARAMETERS = {
    "master_id": 32768,
    "bit_rate_kbps": 32769,
    "cycle_ms": 32772,
    "nodes": 32770,
}
DRIVE_FLAGS = {
    "uses_signals": 8468,
    "step_and_direction": 8464,
    "disable_on_excess_error_only": 8470,
    "disable_on_excess_error": 8469,
    "is_fault_inverted": 8453,
    "disable_on_kill": 8471,
}
CONTACT_FLAGS, SWITCH_FLAGS, SOFT_FLAGS = (16144, 16145), (16148, 16149), (16150, 16151)
PROFILE_WORDS = ("acc", "dec", "stp", "vel", "jrk")


def setup_code(answers: Answers, plcs: int) -> Iterator[str]:
    """All lines; `plcs` is how many PLCs watch the limits (older firmware)."""
    yield from ("SYS", "HALT ALL", "NEW ALL", "CLEAR", "DETACH ALL", "")
    yield from _memory(answers, plcs)
    if not answers.card.minimal:
        yield from _hardware(answers)
    for axis in answers.axis:
        yield from _axis(axis)
    unused = [n for n in range(answers.card.hardware.axes) if n not in answers.used_axes]
    if unused:
        yield "REM Axes that are not there cost processor time only"
        yield from (f"AXIS{number} OFF" for number in unused)
        yield ""
    if plcs:
        yield from _soft_limits(answers)
    for master in answers.master:
        yield from _master(answers, master)


def _memory(answers: Answers, plcs: int) -> Iterator[str]:
    yield f"REM Configuration of {answers.card.model} {answers.card.option}".rstrip()
    yield "REM P0-P99 and P201-P4095 are free for user programs"
    yield "REM P100-P200 are used by generated code"
    sizes = (PROGRAM_BYTES[0] + BUFFERED_MOVE.bytes(answers.card.moves), *PROGRAM_BYTES[1:])
    for program, size in enumerate(sizes):
        is_watch = plcs > 0 and program == WATCH_PROGRAM
        yield f"DIM PROG{program}({WATCH_BYTES if is_watch else size})"
    numbers = (*range(answers.card.plcs), *range(FIRST_PLC, FIRST_PLC + plcs))
    yield from (f"DIM PLC{number}({PLC_BYTES})" for number in numbers)
    yield f"DIM P({WATCHED_PARAMETERS if plcs else USER_PARAMETERS})"
    yield f"DIM DEF({DEFINES})"
    yield ""


def _hardware(answers: Answers) -> Iterator[str]:
    yield "REM 16-bit analog inputs; CANopen master, bit rate, cycle and nodes"
    yield "ADC MODE 1"
    for key, number in CANOPEN_PARAMETERS.items():
        yield f"P{number}={getattr(answers.card.canopen, key)}"
    yield ""


def _axis(axis: AxisAnswers) -> Iterator[str]:
    n, encoder, dac = axis.number, axis.feedback, axis.output
    yield f"REM Axis {n}: {axis.name}"
    yield f"ATTACH AXIS{n} ENC{encoder} DAC{dac} ENC{encoder}"
    yield f"AXIS{n} PPU {ppu_word(axis.units_per_rev, axis.counts_per_rev)}"
    yield f"AXIS{n} EXC ({plain(axis.excess_error)},{plain(-axis.excess_error)})"
    yield from _drive(axis)
    yield f"ENC{encoder} SRC 0"
    yield f"ENC{encoder} MULT 4"
    for word in axis.gains.__struct_fields__:
        yield f"AXIS{n} {word.upper()} {plain(getattr(axis.gains, word))}"
    yield from _limits(axis)
    yield f"DAC{dac} GAIN {DAC_GAIN}"
    yield f"AXIS{n} ON"
    yield ""


def _drive(axis: AxisAnswers) -> Iterator[str]:
    for key, number in DRIVE_FLAGS.items():
        yield _flag(number, axis, getattr(axis.drive, key))


def _limits(axis: AxisAnswers) -> Iterator[str]:
    limits, n = axis.limits, axis.number
    if axis.limit_input:
        yield f"AXIS{n} HLBIT {axis.limit_input}"
    yield f"AXIS{n} HLDEC {plain(limits.deceleration)}"
    yield from (_flag(number, axis, limits.contacts_are_closed) for number in CONTACT_FLAGS)
    yield from (_flag(number, axis, limits.is_enabled) for number in SWITCH_FLAGS)
    if limits.soft is not None:
        yield f"AXIS{n} SLM ({plain(limits.soft[0])},{plain(limits.soft[1])})"
    deceleration = limits.soft_deceleration
    deceleration = limits.deceleration if deceleration is None else deceleration
    yield f"AXIS{n} SLDEC {plain(deceleration)}"
    yield from (_flag(number, axis, limits.watches_soft) for number in SOFT_FLAGS)


def _soft_limits(answers: Answers) -> Iterator[str]:
    yield "REM Ends of travel by position"
    for axis in answers.axis:
        for first, position in zip(
            (SOFT_POSITIVE, SOFT_NEGATIVE), axis.limits.soft or (), strict=False
        ):
            yield f"P{first + axis.number}={plain(position)}"
    yield ""


def _master(answers: Answers, master: MasterAnswers) -> Iterator[str]:
    yield f"REM Master {master.number}: {' '.join(master.axes)}"
    yield f"PROG{answers.program_of(master.number)}"
    yield "DETACH"
    yield f"ATTACH MASTER{master.number}"
    for slave, name in enumerate(master.axes):
        yield f'ATTACH SLAVE{slave} AXIS{answers.named(name).number} "{name}"'
    for word in PROFILE_WORDS:
        yield f"{word.upper()} {plain(getattr(master, word))}"
    yield ""


def _flag(first: int, axis: AxisAnswers, on: bool) -> str:
    """Switch a flag of an axis, `first` being that of axis 0."""
    return f"{'SET' if on else 'CLR'} BIT{first + FLAGS_PER_AXIS * axis.number}"


def pulses_per_unit(units_per_rev: float, counts_per_rev: int) -> float:
    """PPU; the length of a turn is a single-precision number, as in the card."""
    (turn,) = struct.unpack("f", struct.pack("f", units_per_rev))
    return float(counts_per_rev / turn)


def ppu_word(units_per_rev: float, counts_per_rev: int) -> str:
    """PPU as the code writes it; a card may round that to another number than the ratio."""
    return f"{pulses_per_unit(units_per_rev, counts_per_rev):.6f}"


def plain(value: float) -> str:
    """A number in six digits, exponents in three: 0.00001 is 1e-005."""
    return re.sub(r"e([+-])(\d\d)$", r"e\g<1>0\2", f"{value:.6g}")
