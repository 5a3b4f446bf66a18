"""A tool changer with a carousel and a clamp."""

from typing import Annotated, ClassVar

from msgspec import Meta

from openacr.plant.devices.device import Device, Values, ramp

Pockets = Annotated[int, Meta(ge=2, le=15)]
Seconds = Annotated[float, Meta(gt=0, le=3600)]
IN_PLACE_POCKETS = 0.05  # distance from the middle of a pocket within which its switch is active


class ToolChanger(Device):
    """A carousel that turns while commanded, and a clamp that opens.

    The pocket at the spindle is reported in binary, counted from 1, while it is in place. The
    carousel does not turn with both directions commanded.
    """

    COMMANDS: ClassVar = {"forward": bool, "backward": bool, "unclamp": bool}
    SIGNALS: ClassVar = {
        "in_place": bool, "code1": bool, "code2": bool, "code4": bool, "code8": bool,
        "clamped": bool, "unclamped": bool,
    }  # fmt: skip

    pockets: Pockets = 8
    pocket_s: Seconds = 0.5
    clamp_s: Seconds = 0.2
    _turned: float = 0.0  # pockets, from the first one
    _clamp: float = 1.0  # 1 clamped, 0 unclamped

    def step(self, dt_s: float, commands: Values) -> Values:
        """Turn the carousel and move the clamp."""
        direction = bool(commands["forward"]) - bool(commands["backward"])
        self._turned = (self._turned + direction * dt_s / self.pocket_s) % self.pockets
        self._clamp = ramp(self._clamp, 0.0 if commands["unclamp"] else 1.0, dt_s / self.clamp_s)
        nearest = round(self._turned)
        is_in_place = abs(self._turned - nearest) <= IN_PLACE_POCKETS
        code = nearest % self.pockets + 1 if is_in_place else 0
        return {
            "in_place": is_in_place,
            **{f"code{bit}": code & bit != 0 for bit in (1, 2, 4, 8)},
            "clamped": self._clamp == 1.0,
            "unclamped": self._clamp == 0.0,
        }
