"""Set-up of a card for the machine: commands sent before a run, none of which causes motion.

Axis order, axis index and slave index are the same, so that X, Y and Z are slaves 0, 1, 2:
arc packets know only those. Drives are left as they are.
"""

import re
from bisect import bisect_left
from collections.abc import Iterator, Mapping

from openacr.client import Card
from openacr.client.errors import RefusedError
from openacr.client.values import number_text
from openacr.cnc.occupied import HOLD_AT, RAN_SHORT
from openacr.errors import UserError
from openacr.map.rows import masters
from openacr.mill.card import soft_limits
from openacr.mill.card.ballscrew import Table, install
from openacr.mill.config.curves import PERIOD_S, RANK, can_plan
from openacr.mill.config.settings import Settings
from openacr.mill.config.tabs import AxisSettings
from openacr.models import Feature
from openacr.sysvar.schema import AXES
from openacr.wording import counted

GAIN_WORDS = (
    "PGAIN",
    "IGAIN",
    "IDELAY",
    "ILIMIT",
    "DGAIN",
    "DWIDTH",
    "FFACC",
    "FFVEL",
    "TLM",
    "FBVEL",
)
DAC_GAIN = 3276.8  # counts per volt
NO_TEST_U = 1e9  # a band that is never exceeded
USER_VARIABLES = 100
MOVES = 200  # moves the card holds at least, where its memory allows
MOVES_WITHOUT_MEMORY = 10
DIMENSIONED = re.compile(r"\bMBUF\s*\(\s*(\d+)\s*\)")  # in the answer to DIM
RAPID_MODES, SPIRAL, CLEAR_REQUEST = 5, 24, 4  # in the secondary flags of a master
MODE_FLAGS, FLAGS_PER_MASTER = 2048, 32
START_MOVE_INHIBIT = 540  # of master 0: left by a host that was lost before a curve began
VELOCITY_LIMIT, PARAMETERS_PER_MASTER = 8232, 256


def prepare(
    card: Card,
    settings: Settings,
    tables: Mapping[int, Table] | None = None,
    *,
    has_extensions: bool = False,
    moves: int = MOVES,
) -> int:
    """Set the card up for the machine, with ballscrew tables; how many moves its buffer holds.

    `moves`: those it is to hold where the card has memory for them and it is not dimensioned yet.
    `has_extensions`: a card of openacr itself, which takes up backlash at every reversal.
    """
    user_variables(card)
    program = settings.master
    for line in lines(settings):
        card.command(line, program=program)
    if has_extensions:
        for axis in settings.axes:
            card.command(f"AXIS{axis.index} BKL DIR 1", program=program)
    install(card, settings, tables or {})
    return _buffer(card, program, moves)


def user_variables(card: Card) -> None:
    """Dimension P0 to P99 of the card if it has no variables; UserError if it has fewer."""
    if _has_variable(card, USER_VARIABLES - 1):
        return
    card.command("SYS")
    try:
        card.command(f"DIM P({USER_VARIABLES})")
    except RefusedError as error:
        count = bisect_left(range(USER_VARIABLES), True, key=lambda n: not _has_variable(card, n))
        raise UserError(
            f"the front end needs P0 to P{USER_VARIABLES - 1}, the card has"
            f" {counted(count, 'variable')}: write DIM P({USER_VARIABLES}) in its set-up ({error})"
        ) from None


def _has_variable(card: Card, number: int) -> bool:
    try:
        card.ask(f"P{number}")
    except RefusedError:
        return False
    return True


def _buffer(card: Card, program: int, moves: int) -> int:
    """Dimension the move buffer, unless an earlier program has; returns its depth in moves."""
    for depth in dict.fromkeys((moves, MOVES)):
        try:
            card.command(f"DIM MBUF({depth})", program=program)
            break
        except RefusedError:  # it is dimensioned, or there is no memory for it
            continue
    else:
        listed = " ".join(card.command("DIM", program=program))
        found = DIMENSIONED.search(listed)
        depth = int(found[1]) if found else MOVES_WITHOUT_MEMORY
    try:
        card.command("MBUF ON", program=program)
    except RefusedError:
        return 1
    return depth


def lines(settings: Settings) -> Iterator[str]:
    """The set-up commands of one program: master, axes and servo loops."""
    master = settings.master
    yield "DETACH"
    yield f"ATTACH MASTER{master}"
    for axis in settings.axes:
        yield f'ATTACH SLAVE{axis.index} AXIS{axis.index} "{axis.name}"'
    for axis in settings.axes:
        yield from _axis(axis)
        yield from soft_limits.lines(axis, settings.speeds.feed_acc_ups2)
    yield from _spindle(settings)
    yield "VECDEF " + " ".join(f"{one.name}{int(one.is_linear)}" for one in settings.axes)
    yield "FOV 1"
    yield "ROV 1"
    yield f"JRK {_number(settings.lowest_jerk_ups3)}"
    if Feature.LOOK_AHEAD not in settings.model.lacks:
        yield "LOOK OFF"  # the front end plans the corners
    if can_plan(settings):
        yield from _curves(settings)
    yield from _modes(settings)


def _curves(settings: Settings) -> Iterator[str]:
    """Prepare the master for NURBs in time: their order, the time of a knot, no ramp."""
    master = settings.master
    yield f"NURB RANK {RANK}"
    yield f"P{masters.nurb_time_factor[master]}={_number(PERIOD_S)}"
    yield f"P{masters.nurb_start_time[master]}=0"
    yield f"P{HOLD_AT}=0"
    yield f"CLR {RAN_SHORT}"
    yield f"CLR {START_MOVE_INHIBIT + FLAGS_PER_MASTER * master}"


def _axis(axis: AxisSettings) -> Iterator[str]:
    word, encoder = f"AXIS{axis.index}", axis.encoder
    yield f"ATTACH {word} ENC{encoder} DAC{axis.dac} ENC{encoder}"
    yield f"ENC{encoder} MULT {axis.multiplier}"
    yield f"{word} PPU {_number(axis.pulses_per_unit)}"
    for gain, value in zip(GAIN_WORDS, axis.gains, strict=True):
        yield f"{word} {gain} {_number(value)}"
    yield f"DAC{axis.dac} GAIN {_number(-DAC_GAIN if axis.is_inverted else DAC_GAIN)}"
    yield f"{word} IPB {_number(axis.in_position_u or NO_TEST_U)}"
    yield f"{word} EXC {_number(axis.excess_error_u or NO_TEST_U)}"
    yield f"{word} BKL {_number(axis.backlash_u)}"
    yield f"{word} JOG ACC {_number(axis.jog_acc_ups2)}"
    yield f"{word} JOG DEC {_number(axis.jog_dec_ups2)}"
    yield f"{word} ON"
    yield f"{word} JOG RES"  # a jog offset left by a host that was lost


def _spindle(settings: Settings) -> Iterator[str]:
    """Switch off the axis with the number of the spindle DAC: it would also write to that DAC."""
    dac = settings.spindle.dac
    if 0 <= dac < AXES and all(axis.index != dac for axis in settings.axes):
        yield f"AXIS{dac} OFF"


def _modes(settings: Settings) -> Iterator[str]:
    """Enable rapid modes and spirals, latch kills until cleared, set the speed limit."""
    base = MODE_FLAGS + FLAGS_PER_MASTER * settings.master
    yield f"SET {base + RAPID_MODES}"
    yield f"SET {base + SPIRAL}"
    yield f"CLR {base + CLEAR_REQUEST}"
    limit = VELOCITY_LIMIT + PARAMETERS_PER_MASTER * settings.master
    yield f"P{limit}={_number(settings.speeds.max_ups)}"


def _number(value: float) -> str:
    return number_text(float(value))
