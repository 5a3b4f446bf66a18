"""Servo control: gains, dead zone and digital filters of an axis."""

from __future__ import annotations

from collections.abc import Callable

from openacr.basic.commands.value_commands import Value, axis_values
from openacr.basic.language.grammar import AxisGroups, AxisValue
from openacr.basic.language.number_format import number_text
from openacr.basic.language.registry import BY_OBJECT, command
from openacr.basic.vm.run import Run
from openacr.errors import CardError
from openacr.map.rows import axes as axis_rows
from openacr.messages import INVALID_ARGUMENT
from openacr.motion.axis import filters
from openacr.motion.axis.settings import (
    activate_derivative_smoothing,
    fp32,
    fp64,
    long,
    not_negative,
)
from openacr.motion.card import Card

GROUP = "Servo Control"
REF = "PG Servo Control"


def gain(
    words: str,
    row: tuple[int, ...],
    doc: str,
    units: str,
    default: str = "0",
    then: Callable[[Card, int], None] | None = None,
) -> Value:
    """A row whose value is an FP32 parameter."""
    return Value(words, fp32(row), doc, units, default, then=then)


axis_values(
    (
        gain("PGAIN", axis_rows.proportional_gain,
             "Set the proportional gain.", "V/pulse", "0.002441406"),
        gain("IGAIN", axis_rows.integral_gain, "Set the integral gain.", "V/s/pulse"),
        gain("ILIMIT", axis_rows.integral_limit,
             "Limit the integral term; 0 keeps it at 0.", "V"),
        gain("IDELAY", axis_rows.integral_delay,
             "Set how long after motion the integral waits; 0 integrates always.", "s"),
        gain("DGAIN", axis_rows.derivative_gain,
             "Set the derivative gain, and put DGain Smooth into effect.", "V/(pulse/s)",
             then=activate_derivative_smoothing),
        gain("DWIDTH", axis_rows.derivative_width,
             "Set the sample period of the derivative; 0 samples every tick.", "s"),
        gain("FFVEL", axis_rows.feedforward_velocity,
             "Set the velocity feedforward gain.", "V/(pulse/s)"),
        gain("FFACC", axis_rows.feedforward_accel,
             "Set the acceleration feedforward gain.", "V/(pulse/s2)"),
        gain("FBVEL", axis_rows.fbvel_gain_setting,
             "Set the velocity feedback gain.", "V/(pulse/s)"),
        gain("DIN", axis_rows.din,
             "Set the integral term taken when the error leaves the dead zone downwards.", "V"),
        gain("DIP", axis_rows.dip,
             "Set the integral term taken when the error leaves the dead zone upwards.", "V"),
        gain("KVF", axis_rows.kvf, "Set the velocity feedforward of the PV loop.", "V/(pulse/s)"),
        gain("KVI", axis_rows.kvi, "Set the integral gain of the PV loop.", "1/s"),
        gain("KVP", axis_rows.kvp,
             "Set the proportional gain of the PV loop; above 0 it replaces the PID loop.", "V/V"),
        Value("FFVC", long(axis_rows.ffvc),
              "Leave the velocity feedforward out below this commanded speed.", "pulses/s"),
        Value("DZL", long(axis_rows.dzl),
              "Set the error below which an axis at rest enters the dead zone.", "pulses"),
        Value("DZU", long(axis_rows.dzu),
              "Set the error above which the axis leaves the dead zone; 0 is no zone.", "pulses"),
    ),
    group=GROUP,
    ref=REF,
)  # fmt: skip


def _redesign(card: Card, axis: int) -> None:
    filters.set_low_pass(card, axis, filters.low_pass_hz(card, axis))


axis_values(
    (
        Value("LOPASS", fp64(axis_rows.lopass_hz, not_negative),
              "Make filter 0 a low-pass with this cut-off frequency; 0 is no filter.", "Hz",
              then=_redesign),
    ),
    group=GROUP,
    ref=REF,
)  # fmt: skip


@command(
    "NOTCH",
    group=GROUP,
    levels=BY_OBJECT,
    grammar=(AxisGroups("center", "width", single=True, values_optional=True),),
    ref=REF,
    units="Hz",
    default="0,0",
    saved=True,
)
def notch(run: Run, axes: tuple[AxisValue, ...]) -> None:
    """Make filter 1 a notch with this centre and width; 0 is no filter."""
    for item in axes:
        _check_notch(item.values)
    for item in axes:
        if item.is_query:
            run.print(",".join(map(number_text, filters.notch_hz(run.card, item.axis.number))))
        else:
            center, width = (*item.values, 0.0)[:2]
            filters.set_notch(run.card, item.axis.number, center, width)


def _check_notch(values: tuple[float, ...]) -> None:
    """A single value can only be the 0 that switches the filter off."""
    if any(value < 0.0 for value in values) or (len(values) == 1 and values[0]):
        raise CardError(INVALID_ARGUMENT)
