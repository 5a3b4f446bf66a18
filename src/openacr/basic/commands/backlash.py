"""Setpoint control: backlash."""

from openacr.basic.commands.value_commands import Value, axis_values
from openacr.basic.language.registry import EXTENSION
from openacr.map.numbers import AX_BACKLASH_SETTING, AXI_BACKLASH_BY_DIRECTION
from openacr.motion.axis.settings import of_axis, of_axis_int, switch

axis_values(
    (
        Value("BKL", of_axis(AX_BACKLASH_SETTING),
              "Set the backlash added to the setpoint while it is positive.", "units", bare=True),
    ),
    group="Setpoint Control",
    ref="PG Setpoint Control",
)  # fmt: skip

axis_values(
    (
        Value("BKL DIR", of_axis_int(AXI_BACKLASH_BY_DIRECTION, switch),
              "Take up the backlash at every reversal (1), or by the sign of the setpoint (0)."),
    ),
    group="Setpoint Control",
    ref=EXTENSION,
)  # fmt: skip
