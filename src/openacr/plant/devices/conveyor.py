"""A conveyor with parts on it."""

from typing import Annotated, ClassVar

from msgspec import Meta, field

from openacr.plant.devices.device import Device, Values

Length = Annotated[float, Meta(gt=0, le=1e6)]
Place = Annotated[float, Meta(ge=0, le=1e6)]
Speed = Annotated[float, Meta(ge=-1e6, le=1e6)]


class Conveyor(Device):
    """A belt that carries parts from its beginning past a sensor and over its end.

    The belt runs at `speed_mm_s` while `run` is on, and in addition at `mm_s_per_volt` times
    the volts of `speed`. A rising edge of `place` puts a part down with its rear edge at 0, if
    the place is free, one of `take` takes the part at the sensor away; `jam` holds all parts
    while the belt slips beneath them.
    """

    COMMANDS: ClassVar = {"run": bool, "speed": float, "place": bool, "take": bool, "jam": bool}
    SIGNALS: ClassVar = {"entry": bool, "part": bool}

    length_mm: Length = 1000.0
    part_mm: Length = 50.0
    sensor_mm: Place = 800.0
    speed_mm_s: Speed = 100.0
    mm_s_per_volt: Speed = 0.0
    _fronts_mm: list[float] = field(default_factory=list)  # front edges, the foremost part first
    _was_placing: bool = False
    _was_taking: bool = False

    def step(self, dt_s: float, commands: Values) -> Values:
        """Carry the parts."""
        speed_mm_s = self.mm_s_per_volt * commands["speed"]
        if commands["run"]:
            speed_mm_s += self.speed_mm_s
        if not commands["jam"]:
            moved = (front + speed_mm_s * dt_s for front in self._fronts_mm)
            self._fronts_mm = [
                front for front in moved if 0.0 < front and front - self.part_mm < self.length_mm
            ]
        if commands["place"] and not self._was_placing and not self._covers(self.part_mm):
            self._fronts_mm.append(self.part_mm)
        if commands["take"] and not self._was_taking:
            self._fronts_mm = [front for front in self._fronts_mm if not self._is_seen(front)]
        self._was_placing, self._was_taking = bool(commands["place"]), bool(commands["take"])
        return {
            "entry": self._covers(self.part_mm),
            "part": any(map(self._is_seen, self._fronts_mm)),
        }

    def _is_seen(self, front_mm: float) -> bool:
        return front_mm - self.part_mm <= self.sensor_mm < front_mm

    def _covers(self, up_to_mm: float) -> bool:
        """Whether a part lies on the belt between 0 and a place."""
        return any(front - self.part_mm < up_to_mm for front in self._fronts_mm)
