"""An index profile: one move of one axis with speed and ramps of its own, as the scope runs it.

    ACC 500
    DEC 500
    STP 500
    JRK 0
    F500
    RES X
    X15

Ramps are in units/s2, the jerk in units/s3, F in units/min. The move counts from where the axis
is: RES, which makes that 0 on a bare card, changes no position of the machine.
"""

import re
from collections.abc import Collection
from dataclasses import dataclass

from openacr.errors import UserError

NUMBER = r"([+-]?(?:\d+\.?\d*|\.\d+))"
SETTING = re.compile(rf"(ACC|DEC|STP|JRK|F)\s*{NUMBER}")
RESET = re.compile(r"RES\s*([A-Z])")
MOVE = re.compile(rf"([A-Z])\s*/?\s*{NUMBER}")
SECONDS_PER_MINUTE = 60.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Profile:
    """A move of one axis: distance, speed and ramps in units, units/s, units/s2 and units/s3."""

    axis: str
    distance_u: float
    speed_ups: float
    acc_ups2: float
    stop_ups2: float
    jerk_ups3: float

    @property
    def time_s(self) -> float:
        """How long the move takes without jerk."""
        path_u, speed_ups = abs(self.distance_u), self.speed_ups
        ramps = 0.5 * (1.0 / self.acc_ups2 + 1.0 / self.stop_ups2)
        if speed_ups**2 * ramps > path_u:  # the speed is not reached
            speed_ups = (path_u / ramps) ** 0.5
        return path_u / speed_ups + speed_ups * ramps


def parse(text: str, names: Collection[str]) -> Profile:
    """Parse a profile; UserError names the first wrong line."""
    values: dict[str, float] = {}
    move: tuple[str, float] | None = None
    for number, line in enumerate(text.splitlines(), 1):
        word = line.strip().upper()
        if not word:
            continue
        where = f"line {number} of the profile"
        if move is not None:
            raise UserError(f"{where}: {word[:40]}: nothing follows the move")
        if found := SETTING.fullmatch(word):
            values[found[1]] = float(found[2])
        elif found := RESET.fullmatch(word):
            _require_axis(where, found[1], names)
        elif found := MOVE.fullmatch(word):
            _require_axis(where, found[1], names)
            move = found[1], float(found[2])
        else:
            wanted = "ACC, DEC, STP, JRK, F, RES or a move is expected"
            raise UserError(f"{where}: {word[:40]!r}: {wanted}")
    return _profile(values, move)


def _require_axis(where: str, name: str, names: Collection[str]) -> None:
    if name not in names:
        raise UserError(f"{where}: axis {name} is not configured; configured are {' '.join(names)}")


def _profile(values: dict[str, float], move: tuple[str, float] | None) -> Profile:
    if move is None or not move[1]:
        raise UserError("the profile moves no axis: it ends with a move such as X15")
    for word in ("ACC", "STP", "F"):
        if values.get(word, 0.0) <= 0.0:
            raise UserError(f"the profile needs {word} above 0")
    if values.get("DEC", 0.0) < 0.0 or values.get("JRK", 0.0) < 0.0:
        raise UserError("DEC and JRK of the profile cannot be negative")
    return Profile(
        axis=move[0],
        distance_u=move[1],
        speed_ups=values["F"] / SECONDS_PER_MINUTE,
        acc_ups2=values["ACC"],
        stop_ups2=values["STP"],
        jerk_ups3=values.get("JRK", 0.0),
    )
