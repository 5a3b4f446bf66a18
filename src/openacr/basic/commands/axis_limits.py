"""Axis limits: bands of error, position and torque, limit switches and software limits."""

from __future__ import annotations

from collections.abc import Callable

from openacr.basic.commands.value_commands import (
    Band,
    Value,
    axis_bands,
    axis_values,
    check_all,
    value_text,
)
from openacr.basic.language.grammar import Axis, AxisList, AxisValue, AxisValues, Either, Int, Word
from openacr.basic.language.nodes import AxisRef
from openacr.basic.language.registry import BY_OBJECT, command
from openacr.basic.vm.run import Run, whole
from openacr.map.numbers import (
    FLAG_LAST,
)
from openacr.map.rows import axes as axis_rows
from openacr.motion.axis import settings
from openacr.motion.axis.settings import (
    LimitEnables,
    fp32,
    fp64,
    long,
    not_negative,
)

GROUP = "Axis Limits"
REF = "PG Axis Limits"


def band(
    words: str,
    plus: tuple[int, ...],
    minus: tuple[int, ...],
    doc: str,
    units: str,
    default: str = "0,0",
) -> Band:
    """A row whose ends are parameters."""
    return Band(words, fp32(plus), fp32(minus), doc, units, default)


axis_bands(
    (
        band("ALM", axis_rows.plus_a_limit, axis_rows.minus_a_limit,
             "Set stroke limit A, the band of the flag Within A Limit.", "units"),
        band("BLM", axis_rows.plus_b_limit, axis_rows.minus_b_limit,
             "Set stroke limit B, the band of the flag Not Within B Limit.", "units"),
        band("EXC", axis_rows.plus_excess_error, axis_rows.minus_excess_error,
             "Set the excess error band of the following error.", "units"),
        band("IPB", axis_rows.plus_in_position, axis_rows.minus_in_position,
             "Set the in-position band of the following error.", "units"),
        band("ITB", axis_rows.plus_torque_band, axis_rows.minus_torque_band,
             "Set the in-torque band of the output signal.", "volts"),
        band("JLM", axis_rows.plus_jog_limit, axis_rows.minus_jog_limit,
             "Set the limits of the jog offset, in force while Jog Limit Check is set.", "units"),
        band("TLM", axis_rows.plus_torque_limit, axis_rows.minus_torque_limit,
             "Limit the output signal; 0 means no torque.", "volts", "10,-10"),
        Band("SLM", fp64(axis_rows.slm_plus_u), fp64(axis_rows.slm_minus_u),
             "Set the positions of the software limits.", "units"),
    ),
    group=GROUP,
    ref=REF,
)  # fmt: skip


def flag_number(value: float) -> bool:
    """What HLBIT takes."""
    return 0.0 <= value <= FLAG_LAST


axis_values(
    (
        Value("HLBIT", long(axis_rows.hlbit, flag_number),
              "Assign three inputs: positive limit, negative limit and home, from this flag on.",
              default="3 times the axis"),
        Value("HLDEC", fp64(axis_rows.hldec_ups2, not_negative),
              "Set the deceleration of hardware limits and kills; 0 stops at once.", "units/s2"),
        Value("SLDEC", fp64(axis_rows.sldec_ups2, not_negative),
              "Set the deceleration of software limits; 0 stops at once.", "units/s2"),
    ),
    group=GROUP,
    ref=REF,
)  # fmt: skip


def limit_mode(words: str, enables: LimitEnables, doc: str) -> None:
    """Register HLIM or SLIM: the mode is the state of two flags."""

    def handler(run: Run, axes: tuple[AxisValue, ...]) -> None:
        for item in axes:
            if item.is_query:
                run.print(str(enables.read(run.card, item.axis.number)))
            else:
                enables.write(run.card, item.axis.number, whole(item.value))

    handler.__doc__ = doc
    grammar = (AxisList(Int("mode", 0, 3, optional=True)),)
    enter: Callable[..., object] = command(
        words, group=GROUP, levels=BY_OBJECT, grammar=grammar, ref=REF, default="0", saved=True
    )
    enter(handler)


limit_mode(
    "HLIM",
    settings.HARD_LIMITS,
    "Enable hardware limits: 0 none, 1 positive, 2 negative, 3 both.",
)
limit_mode(
    "SLIM",
    settings.SOFT_LIMITS,
    "Enable software limits: 0 none, 1 positive, 2 negative, 3 both.",
)


@command(
    "MAXVEL",
    group=GROUP,
    levels=BY_OBJECT,
    grammar=(Either(Word("OFF"), AxisValues()),),
    ref=REF,
    units="units/s",
    default="0",
    saved=True,
)
def maxvel(run: Run, given: str | tuple[AxisValue, ...]) -> None:
    """Limit the speed of an axis in coordinated moves; 0 is no limit, OFF clears all."""
    if isinstance(given, str):
        for axis in _meant(run):
            settings.set_max_velocity(run.card, axis.number, 0.0)
        return
    limit = settings.MAX_VELOCITY
    check_all(given, limit)
    for item in given:
        if item.is_query:
            run.print(value_text(limit, limit.read(run.card, item.axis.number)))
        else:
            settings.set_max_velocity(run.card, item.axis.number, item.value)


def _meant(run: Run) -> tuple[Axis, ...]:
    """The axis of the prefix `AXISn`, else all axes of the program."""
    if run.prefix is None:
        return run.axes()
    return (run.axis(AxisRef("AXIS", run.prefix.number)),)
