"""A spindle with inertia on a frequency converter."""

from typing import Annotated, ClassVar

from msgspec import Meta

from openacr.plant.devices.device import Device, Values, ramp

Scale = Annotated[float, Meta(gt=0, le=1e6)]
Share = Annotated[float, Meta(ge=0, le=1)]


class Spindle(Device):
    """A spindle that reaches its speed along a ramp.

    With `forward` or `reverse` it runs up to the speed that the volts of `speed` ask for, without
    either (or with both) it is braked to rest. `speed` as a signal is the actual speed in the
    same volts, negative in reverse.
    """

    COMMANDS: ClassVar = {"forward": bool, "reverse": bool, "speed": float}
    SIGNALS: ClassVar = {"at_speed": bool, "stopped": bool, "speed": float}

    rpm_per_volt: Scale = 2400.0
    rpm_per_s: Scale = 12000.0  # ramp of run-up and braking
    at_speed_share: Share = 0.02  # of the speed asked for, within which it is reached
    _rpm: float = 0.0

    def step(self, dt_s: float, commands: Values) -> Values:
        """Follow the ramp."""
        direction = bool(commands["forward"]) - bool(commands["reverse"])
        goal_rpm = direction * max(0.0, commands["speed"]) * self.rpm_per_volt
        self._rpm = ramp(self._rpm, goal_rpm, self.rpm_per_s * dt_s)
        is_near = abs(self._rpm - goal_rpm) <= self.at_speed_share * abs(goal_rpm)
        return {
            "at_speed": goal_rpm != 0.0 and is_near,
            "stopped": self._rpm == 0.0,
            "speed": self._rpm / self.rpm_per_volt,
        }
