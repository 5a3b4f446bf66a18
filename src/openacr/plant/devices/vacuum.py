"""A vacuum cup on an ejector."""

from typing import Annotated, ClassVar

from msgspec import Meta

from openacr.cmath import exp
from openacr.plant.devices.device import Device, Values

Seconds = Annotated[float, Meta(gt=0, le=3600)]
Vacuum = Annotated[float, Meta(ge=0, le=1.013)]
Scale = Annotated[float, Meta(ge=-1e3, le=1e3)]


class VacuumCup(Device):
    """A cup that is evacuated while `on`, far enough only if a part closes it.

    The vacuum (bar below the air) follows first-order lags towards `closed_bar` with a part and
    `open_bar` without, and towards 0 while off. `held` comes at `held_bar` and goes at
    `lost_bar`.
    """

    COMMANDS: ClassVar = {"on": bool, "part": bool}
    SIGNALS: ClassVar = {"held": bool, "vacuum": float}

    closed_bar: Vacuum = 0.8
    open_bar: Vacuum = 0.1
    held_bar: Vacuum = 0.6
    lost_bar: Vacuum = 0.5
    evacuate_s: Seconds = 0.1  # time constants
    vent_s: Seconds = 0.05
    volts_per_bar: Scale = 10.0
    _bar: float = 0.0
    _is_held: bool = False

    def step(self, dt_s: float, commands: Values) -> Values:
        """Evacuate or vent the cup."""
        goal_bar = 0.0
        if commands["on"]:
            goal_bar = self.closed_bar if commands["part"] else self.open_bar
        lag_s = self.evacuate_s if goal_bar > self._bar else self.vent_s
        self._bar = goal_bar + (self._bar - goal_bar) * exp(-dt_s / lag_s)
        self._is_held = self._bar >= (self.lost_bar if self._is_held else self.held_bar)
        return {"held": self._is_held, "vacuum": self._bar * self.volts_per_bar}
