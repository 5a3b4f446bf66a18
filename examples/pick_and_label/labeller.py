"""A labeller that works only while the head with the part is beneath it."""

from typing import ClassVar

from openacr.plant.devices.device import Device


class Labeller(Device):
    """Applies a label in `label_s` after `start`; a fault if the head is elsewhere meanwhile."""

    COMMANDS: ClassVar = {"start": bool, "head_mm": float}
    SIGNALS: ClassVar = {"done": bool, "fault": bool}

    at_mm: float = 100.0
    tolerance_mm: float = 0.5
    label_s: float = 0.4
    labels: int = 1000  # on the roll
    _worked_s: float = 0.0
    _is_faulty: bool = False

    def step(self, dt_s, commands):
        """Work while started."""
        if not commands["start"]:
            self._worked_s, self._is_faulty = 0.0, False
        elif self._worked_s < self.label_s and not self._is_faulty:
            self._worked_s += dt_s
            is_beneath = abs(commands["head_mm"] - self.at_mm) <= self.tolerance_mm
            self._is_faulty = self.labels == 0 or not is_beneath
            if self._worked_s >= self.label_s and not self._is_faulty:
                self.labels -= 1
        is_done = self._worked_s >= self.label_s and not self._is_faulty
        return {"done": is_done, "fault": self._is_faulty}
