"""Record the response of an axis of any card, virtual or real.

Operations on a conversation with the card: `Card.perform` and the screens carry them out.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from openacr.client import Level, RefusedError, stored, values
from openacr.client.effects import Op, Pause
from openacr.client.requests import SYS, Follow
from openacr.client.talk import Talk
from openacr.client.transfer import Progress, download
from openacr.errors import OpenacrError, UserError
from openacr.map.rows import axes
from openacr.tuning.excitation import (
    ARMED,
    DRIVE_FLAG,
    FLAGS_PER_AXIS,
    KILL_FLAG,
    PROGRAM_HZ,
    TITLE,
    Excitation,
    FilterChange,
    set_lines,
)
from openacr.tuning.filters import FILTERS, Filters
from openacr.tuning.settings import BIQUAD_FLAG, ROWS, LoopSettings
from openacr.tuning.twin import Record

PROGRAMS = 16
REST_S = 0.1  # between two looks at an axis that has to be at rest
REST_CNT = 5
SWING_SHARE = 0.05  # of the height
FOLLOWED_SHARE = 0.5  # of the height: what the setpoint has to show of the excitation
HEAR_S = 0.1
TAKE_BACK_S = 0.1  # many rounds of the program
CHANNELS = 3
TAKEN_BACK = "what was changed was taken back"
_OPEN_LOOP, _DRIVE_IO = 785, 8468
_FOLLOWING = {792: "jogs", 788: "is geared", 790: "follows a cam"}


@dataclass(frozen=True, slots=True)
class Measurement:
    """A recorded response, and the settings it was recorded with."""

    axis: int
    excitation: Excitation
    settings: LoopSettings
    record: Record


def settings_of(talk: Talk, axis: int) -> Op[LoopSettings]:
    """The loop settings of an axis of a card."""
    found = yield from values.read_many(talk, [row[axis] for row in ROWS])
    period = yield from talk.query("PERIOD")
    is_filtering = yield from values.read_bit(talk, BIQUAD_FLAG + FLAGS_PER_AXIS * axis)
    rows = dict(zip(ROWS, map(float, found), strict=True))
    filters = yield from _filters_of(talk, axis)
    period_s = float(period[-1])
    coefficients = [rows[row] for filter_ in FILTERS for row in filter_]
    if not filters.are(coefficients, period_s) or is_filtering is not filters.is_filtering:
        return LoopSettings(rows, is_filtering, period_s)
    return LoopSettings(rows, is_filtering, period_s, filters)


def _filters_of(talk: Talk, axis: int) -> Op[Filters]:
    """What LOPASS and NOTCH of an axis were given."""
    (lopass,) = yield from talk.query(f"AXIS{axis} LOPASS")
    (notch,) = yield from talk.query(f"AXIS{axis} NOTCH")
    center, width = notch.split(",")
    return Filters(float(lopass), float(center), float(width))


def require_axis(talk: Talk, axis: int) -> Op[None]:
    """Refuse an axis that the card does not have, or that is off; UserError."""
    try:
        state = yield from talk.query(f"AXIS{axis}")
    except RefusedError:
        raise UserError(f"axis {axis}: this card does not have it") from None
    if state != ("ON",):
        raise UserError(f"axis {axis} is off: ATTACH it, or AXIS{axis} ON")


def require_rest(talk: Talk, axis: int, bound_cnt: float = math.inf) -> Op[None]:
    """Refuse an axis that is off, killed, open, moving or far from its setpoint; UserError."""
    yield from require_axis(talk, axis)
    shift = FLAGS_PER_AXIS * axis
    flags = [DRIVE_FLAG, _DRIVE_IO, KILL_FLAG, _OPEN_LOOP, *_FOLLOWING]
    states = yield from values.read_bits(talk, [flag + shift for flag in flags])
    enabled, has_drive_io, killed, is_open, *following = states
    if has_drive_io and not enabled:
        raise UserError(f"axis {axis} is not enabled: DRIVE ON")
    if killed:
        raise UserError(f"axis {axis}: its motion is killed: CLR {KILL_FLAG + shift}, or Ctrl-Y")
    if is_open:
        raise UserError(f"axis {axis}: its servo loop is open: CLR {_OPEN_LOOP + shift}")
    for does, is_so in zip(_FOLLOWING.values(), following, strict=True):
        if is_so:
            raise UserError(f"axis {axis} {does}: it has to be at rest")
    yield from _require_still(talk, axis, bound_cnt)


def _require_still(talk: Talk, axis: int, bound_cnt: float) -> Op[None]:
    rows = [axes.secondary_setpoint[axis], axes.actual_position[axis]]
    setpoint, actual = yield from values.read_many(talk, rows)
    yield Pause(REST_S)
    later, now = yield from values.read_many(talk, rows)
    if later != setpoint or abs(now - actual) > REST_CNT:
        raise UserError(f"axis {axis} moves: it has to be at rest")
    if abs(later - now) > bound_cnt:
        raise UserError(
            f"axis {axis} is {abs(later - now):g} pulses from its setpoint: at most"
            f" {bound_cnt:g} (is its drive off?)"
        )


def _require_no_cam(talk: Talk, axis: int) -> Op[None]:
    """Refuse an axis that has a cam of its own; UserError."""
    if (yield from talk.query(f"AXIS{axis} CAM DIM")) != ("0",):
        raise UserError(
            f"axis {axis} has a cam, which a sweep above {PROGRAM_HZ:g} Hz needs:"
            f" AXIS{axis} CAM CLEAR, or a lower frequency"
        )


def measure(
    talk: Talk,
    axis: int,
    excitation: Excitation,
    *,
    gains: Mapping[str, float] | None = None,
    filters: Filters | None = None,
    program: int | None = None,
    progress: Progress | None = None,
) -> Op[Measurement]:
    """Excite an axis at rest and record it; UserError where a bound was exceeded.

    The card does it in a program that is empty (or `program`), which is erased afterwards. The
    excitation of the measurement is the one that was made: it may have been shortened.
    `gains` and `filters` are set before; they stay, unless a bound is exceeded or the axis does
    not come to rest: then the former ones are set again. `stop` ends it from another connection.
    """
    excitation, gains = excitation.checked(), gains or {}
    yield from require_axis(talk, axis)
    former = yield from settings_of(talk, axis)
    former.require_modelled()
    excitation.require_rate(former.period_s)
    yield from require_rest(talk, axis, excitation.error_cnt / 4.0)
    if (yield from values.read_bit(talk, ARMED)):
        raise UserError("the sampler of the card is in use: SAMP CLEAR frees it")
    period_s = former.period_s
    level, excitation = yield from _room(talk, excitation, period_s, program)
    count = excitation.samples(period_s)
    if excitation.is_cam:
        yield from _require_no_cam(talk, axis)
    changed = None if filters is None else _change(former, filters)
    text = excitation.program(axis, period_s, gains, changed)
    try:
        yield from download(talk, text, to=level, is_verified=False)
        code, rows = yield from _listen(talk, level, count, progress)
    except (OpenacrError, KeyboardInterrupt):
        yield from _clear(talk, level)
        if excitation.is_cam:
            yield from talk.command(f"AXIS{axis} CAM CLEAR")
        raise
    yield from _clear(talk, level)
    if reason := excitation.ending(code):
        raise UserError(f"axis {axis}: ended, because {reason}; {TAKEN_BACK}")
    if len(rows) != count:
        raise UserError(f"{level}: {len(rows)} of {count} samples came: was it halted?")
    record = _record(rows, period_s)
    if np.ptp(record.setpoint_cnt) < FOLLOWED_SHARE * excitation.height_cnt:
        moved = "cam" if excitation.is_cam else "jog"
        raise UserError(f"axis {axis}: its setpoint does not follow the {moved} offset of the card")
    last = record.actual_cnt[-round(REST_S / period_s) :]
    if gains and np.ptp(last) > max(REST_CNT, SWING_SHARE * excitation.height_cnt):
        yield from write_gains(
            talk,
            axis,
            {word: former.gain(word) for word in gains},
            None if changed is None else changed.former,
        )
        raise UserError(f"axis {axis} swings by {np.ptp(last):g} pulses; {TAKEN_BACK}")
    settings = former.changed(**gains) if gains else former
    settings = settings if filters is None else settings.filtered(filters)
    return Measurement(axis, excitation, settings, record)


def _change(former: LoopSettings, filters: Filters) -> FilterChange:
    """Filters to try, with those before, which LOPASS and NOTCH have to be able to set again."""
    if former.filters is None:
        raise UserError("the filters of the axis were written by hand: they are not changed")
    return FilterChange(filters, former.filters)


def stop(talk: Talk) -> Op[None]:
    """End an excitation: its program takes everything back when the sampler is not armed."""
    yield from talk.order(f"CLR {ARMED}")


def write_gains(
    talk: Talk, axis: int, gains: Mapping[str, float], filters: Filters | None = None
) -> Op[None]:
    """Set gains, and filters if any are given, of an axis at once."""
    for line in [*(filters.lines(axis) if filters else []), *set_lines(axis, gains)]:
        yield from talk.order(line)


def _room(
    talk: Talk, excitation: Excitation, period_s: float, program: int | None
) -> Op[tuple[Level, Excitation]]:
    """A program without text that has the memory, and what fits; UserError if there is none."""
    rooms = yield from stored.rooms(talk)
    numbers = range(PROGRAMS - 1, -1, -1) if program is None else (program,)
    needed = excitation.memory_bytes(period_s)
    empty: dict[Level, int] = {}  # with its memory [bytes]
    for level in map(Level.program, numbers):
        lines = (yield from stored.listing(talk, level)) if level in rooms else []
        if any(line.text.strip().startswith(TITLE) for line in lines):  # of a host that was lost
            yield from _clear(talk, level)
        elif lines:
            continue
        empty[level] = rooms[level].total if level in rooms else 0
        if empty[level] >= needed:
            return level, excitation
    if not empty:
        which = "no program of the card" if program is None else f"PROG{program} of the card"
        verb = "is empty" if program is None else "is not empty"
        raise UserError(f"{which} {verb}: NEW erases one")
    level = max(empty, key=lambda each: empty[each])
    fits = excitation.fitting(empty[level], period_s)
    if excitation.is_shortened and fits is not excitation:
        return level, fits
    where = "no empty program has" if program is None else f"PROG{program} does not have"
    less = f"less time ({fits.duration_s:g} s fit), or " if fits is not excitation else ""
    raise UserError(
        f"{where} {needed} bytes (the largest has {empty[level]}): {less}DIM {level}({needed})"
    )


def _clear(talk: Talk, level: Level) -> Op[None]:
    """End and erase the program of a measurement, after it has taken everything back."""
    yield from talk.leave()
    yield from stop(talk)
    yield Pause(TAKE_BACK_S)
    yield from talk.go(level)
    for line in ("HALT", "NEW", "CLEAR", "SAMP CLEAR"):
        yield from talk.command(line)
    yield from talk.go(SYS)


def _listen(
    talk: Talk, level: Level, count: int, progress: Progress | None
) -> Op[tuple[int, list[list[float]]]]:
    """Run the program: its reason to end, and the samples it prints."""
    text, numbers = "", list[float]()
    yield from talk.go(level)
    yield from talk.exchange(Follow("LRUN"))
    while (piece := (yield from talk.hear(HEAR_S))) is not None:
        *lines, text = (text + piece).split("\n")
        for line in lines:
            numbers += _numbers(level, line)
        if progress is not None:
            progress(max(0, len(numbers) - 1) // CHANNELS, count)
    code, *samples = numbers or [0.0]
    return int(code), [samples[k : k + CHANNELS] for k in range(0, len(samples), CHANNELS)]


def _numbers(level: Level, line: str) -> list[float]:
    """What the program prints in a line; UserError where the card reports an error."""
    try:
        return [float(word) for word in line.split()]
    except ValueError:
        raise UserError(f"{level}: {line.strip()}") from None


def _record(rows: list[list[float]], period_s: float) -> Record:
    setpoint, actual, output = np.array(rows, dtype=np.float64).T
    return Record(period_s, setpoint - setpoint[0], actual - setpoint[0], output)
