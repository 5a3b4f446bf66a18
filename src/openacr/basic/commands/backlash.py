"""Setpoint control: backlash."""

from openacr.basic.commands.value_commands import Value, axis_values
from openacr.map.numbers import AX_BACKLASH_SETTING
from openacr.motion.axis.settings import of_axis

axis_values(
    (
        Value("BKL", of_axis(AX_BACKLASH_SETTING),
              "Set the backlash added to the setpoint while it is positive.", "units", bare=True),
    ),
    group="Setpoint Control",
    ref="PG Setpoint Control",
)  # fmt: skip
