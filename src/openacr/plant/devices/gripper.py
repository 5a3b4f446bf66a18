"""A gripper with two end switches."""

from typing import Annotated, ClassVar

from msgspec import Meta

from openacr.plant.devices.device import Device, Values, ramp

Seconds = Annotated[float, Meta(gt=0, le=3600)]
Share = Annotated[float, Meta(gt=0, lt=1)]


class Gripper(Device):
    """Jaws that close and open in a given time; a part between them stops them on the path.

    `part_at` is the share of the stroke, from open, at which the jaws meet a part.
    """

    COMMANDS: ClassVar = {"close": bool, "part": bool}
    SIGNALS: ClassVar = {"opened": bool, "closed": bool, "gripped": bool}

    close_s: Seconds = 0.2
    open_s: Seconds = 0.2
    part_at: Share = 0.5
    _stroke: float = 0.0  # 0 open, 1 closed

    def step(self, dt_s: float, commands: Values) -> Values:
        """Move the jaws."""
        if commands["close"]:
            is_in_front = commands["part"] and self._stroke <= self.part_at
            end = self.part_at if is_in_front else 1.0
            self._stroke = ramp(self._stroke, end, dt_s / self.close_s)
        else:
            self._stroke = ramp(self._stroke, 0.0, dt_s / self.open_s)
        is_gripped = commands["close"] and commands["part"] and self._stroke == self.part_at
        return {
            "opened": self._stroke == 0.0,
            "closed": self._stroke == 1.0,
            "gripped": is_gripped,
        }
