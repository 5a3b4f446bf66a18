"""A light curtain with a restart interlock."""

from typing import Annotated, ClassVar

from msgspec import Meta

from openacr.plant.devices.device import Device, Values

Response = Annotated[float, Meta(ge=0, le=10)]


class LightCurtain(Device):
    """Its contact opens a response time after the field is interrupted.

    With `interlock` it closes again only with a rising edge of `reset` while the field is
    clear, also after power-up; without, as soon as the field is clear.
    """

    COMMANDS: ClassVar = {"interrupted": bool, "reset": bool}
    SIGNALS: ClassVar = {"clear": bool}

    response_s: Response = 0.02
    interlock: bool = False
    _interrupted_s: float = 0.0
    _is_clear: bool = False
    _was_reset: bool = True

    def step(self, dt_s: float, commands: Values) -> Values:
        """Watch the field."""
        is_reset = commands["reset"] and not self._was_reset
        self._was_reset = bool(commands["reset"])
        if commands["interrupted"]:
            self._interrupted_s += dt_s
            if self._interrupted_s >= self.response_s:
                self._is_clear = False
        else:
            self._interrupted_s = 0.0
            self._is_clear = self._is_clear or is_reset or not self.interlock
        return {"clear": self._is_clear}
