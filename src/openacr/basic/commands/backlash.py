"""Setpoint control: backlash."""

from openacr.basic.commands.value_commands import Value, axis_values
from openacr.basic.language.registry import EXTENSION
from openacr.map.rows import axes
from openacr.motion.axis.settings import fp32, long, switch

axis_values(
    (
        Value("BKL", fp32(axes.backlash_setting),
              "Set the backlash added to the setpoint while it is positive.", "units", bare=True),
    ),
    group="Setpoint Control",
    ref="PG Setpoint Control",
)  # fmt: skip

axis_values(
    (
        Value("BKL DIR", long(axes.backlash_by_direction, switch),
              "Take up the backlash at every reversal (1), or by the sign of the setpoint (0)."),
    ),
    group="Setpoint Control",
    ref=EXTENSION,
)  # fmt: skip
