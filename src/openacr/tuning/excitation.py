"""What is done to an axis while it is recorded, as a program that the card executes by itself.

The program adds a sine sweep or a step to the jog offset, or plays a fast sweep from a cam
(`openacr.tuning.cam_sweep`), lets the sampler record each servo
interrupt, watches the axis, takes the offset back and prints the record. Gains that are tried are
set by the same program, which sets the former ones where a bound is exceeded. A host that is lost
changes nothing: the program ends by itself within its time, with the axis where it was.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

from openacr.errors import UserError
from openacr.map.rows import axes
from openacr.tuning import cam_sweep
from openacr.tuning.filters import Filters
from openacr.tuning.settings import GAINS

TITLE = "REM openacr tune"
PER_LINE = 4  # samples in a printed line
REST_MS = 300  # beside the excitation, still recorded
BEFORE_STEP_S = 0.02  # of that rest: a record begins before its step
ARMED = 104  # Sample Trigger Armed
KILL_FLAG, DRIVE_FLAG, FLAGS_PER_AXIS = 8467, 8465, 32
CLOCK = "P6916"  # ms
BYTES_PER_SAMPLE = 12
BYTES_BESIDE = 8192  # text and variables of the program
PROGRAM_HZ = 150.0  # what a program can write by itself; above it the card plays a cam
RATE_SHARE = 0.4  # of the servo rate: the highest frequency of a cam
BYTES_PER_POINT = 4
LEAST_CNT, MOST_CNT = 5.0, 100_000.0
LEAST_S, MOST_S = 0.2, 10.0
SWEEP_S = 1.5  # of a sweep, where no time is given and there is room for it
SHORTER_S = 0.05  # steps in which an excitation is shortened
ENDS = {
    1: "the following error exceeded {error:g} pulses",
    2: "the axis went further than {travel:g} pulses",
    3: "its motion was killed (a limit, a fault, or an operator)",
    4: "it was stopped",
}


def set_lines(axis: int, gains: Mapping[str, float]) -> list[str]:
    """Lines that set gains of an axis; what damps comes before what stiffens."""
    order = sorted(gains, key=lambda word: (word != "DGAIN", word == "IGAIN"))
    return [f"AXIS{axis} {word} {gains[word]:.7G}" for word in order]


def _taken_back(axis: int, filters: "FilterChange | None") -> list[str]:
    """Lines that set the former filters where a bound is exceeded."""
    lines = filters.former.lines(axis) if filters else []
    return [f"IF (LV3 <> 0) THEN {line}" for line in lines]


@dataclass(frozen=True, slots=True)
class FilterChange:
    """Filters that are tried, and those before."""

    tried: Filters
    former: Filters


@dataclass(frozen=True, slots=True)
class Excitation:
    """A sine sweep or a step, with the bounds that end it; counts, Hz and seconds.

    `is_shortened`: it takes less time where no empty program of the card has room for all of it.
    """

    kind: Literal["sine", "step"] = "sine"
    height_cnt: float = 100.0
    low_hz: float = 2.0
    high_hz: float = 60.0
    duration_s: float = SWEEP_S
    error_cnt: float = 0.0  # 0: four times the height
    travel_cnt: float = 0.0  # 0: four times the height
    is_shortened: bool = False

    def checked(self) -> "Excitation":
        """The same with its bounds; UserError where a value is out of range."""
        for name, value, least, most in (
            ("amplitude [pulses]", self.height_cnt, LEAST_CNT, MOST_CNT),
            ("time [s]", self.duration_s, LEAST_S, MOST_S),
            ("lowest frequency [Hz]", self.low_hz, 0.2, self.high_hz),
            ("highest frequency [Hz]", self.high_hz, self.low_hz, math.inf),
        ):
            if not least <= value <= most:
                raise UserError(f"{name} {value:g}: from {least:g} to {most:g}")
        bound = 4.0 * self.height_cnt
        error, travel = self.error_cnt or bound, self.travel_cnt or bound
        if min(error, travel) < self.height_cnt:
            raise UserError(
                f"bounds below the amplitude of {self.height_cnt:g} pulses end it early"
            )
        return replace(self, error_cnt=error, travel_cnt=travel)

    def fitting(self, room_bytes: int, period_s: float) -> "Excitation":
        """The same, shortened to what a program of the card has room for; itself where none is."""
        fits = self
        while fits.memory_bytes(period_s) > room_bytes:
            shorter_s = round(fits.duration_s - SHORTER_S, 3)
            if shorter_s < LEAST_S:
                return self
            fits = replace(fits, duration_s=shorter_s)
        return fits

    @property
    def is_cam(self) -> bool:
        """Whether the card plays the sweep from a cam."""
        return self.kind == "sine" and self.high_hz > PROGRAM_HZ

    def require_rate(self, period_s: float) -> None:
        """Refuse frequencies that are too high for a servo period; UserError."""
        most = RATE_SHARE / period_s
        if self.is_cam and self.high_hz > most:
            raise UserError(
                f"highest frequency [Hz] {self.high_hz:g}: at most {most:g} with this servo rate"
            )

    def samples(self, period_s: float) -> int:
        """Samples of the record, with the rest after the excitation."""
        count = round((self.duration_s + REST_MS / 1000.0) / period_s)
        return count - count % PER_LINE

    def memory_bytes(self, period_s: float) -> int:
        """What the program needs of the memory of the card."""
        table = cam_sweep.points(self.duration_s, period_s) + 1 if self.is_cam else 0
        return BYTES_BESIDE + BYTES_PER_SAMPLE * self.samples(period_s) + BYTES_PER_POINT * table

    def program(
        self,
        axis: int,
        period_s: float,
        gains: Mapping[str, float] | None = None,
        filters: FilterChange | None = None,
    ) -> str:
        """The program, from PROGRAM to ENDP; it prints its reason to end, then the record.

        `gains` by their words and `filters` are set before, and stay unless a bound is exceeded.
        """
        gains = gains or {}
        former = {GAINS[word][axis]: k for k, word in enumerate(gains)}
        count = self.samples(period_s)
        actual = f"P{axes.actual_position[axis]}"
        written = cam_sweep.offset(axis) if self.is_cam else f"P{axes.jog_offset[axis]}"
        lines = [
            "PROGRAM",
            TITLE,
            *self._room(count, period_s),
            *(f"SAMP 0 SRC P{axes.secondary_setpoint[axis]}", "SAMP 0 BASE LA0"),
            *(f"SAMP 1 SRC {actual}", "SAMP 1 BASE LA1"),
            *(f"SAMP 2 SRC P{axes.output_signal[axis]}", "SAMP 2 BASE SA0"),
            "SAMP PERIOD 0",
            *self._table(axis, period_s),
            f"LV0 = {written}",
            f"LV1 = {actual}",
            "LV3 = 0",
            *(f"SV{k} = P{row}" for row, k in former.items()),
            *(filters.tried.lines(axis) if filters else []),
            *set_lines(axis, gains),
            f"SET {ARMED}",
            *([f"DWL {BEFORE_STEP_S}"] if self.kind == "step" else []),
            *self._begin(axis, actual),
            f"LV2 = {CLOCK}",
            "_MOVE",
            f"IF (BIT{ARMED} = 0) THEN LV3 = 4",
            *self._watch(axis, actual),
            "IF (LV3 <> 0) THEN GOTO BACK",
            *self._drive(axis, written),
            "_BACK",
            *([f"AXIS{axis} CAM OFF"] if self.is_cam else []),
            f"{written} = LV0",
            *self._watch(axis, actual),
            *(f"IF (LV3 <> 0) THEN P{row} = SV{k}" for row, k in former.items()),
            *_taken_back(axis, filters),
            f"IF (BIT{ARMED}) THEN GOTO BACK",
            *(cam_sweep.end_lines(axis) if self.is_cam else []),
            "SAMP CLEAR",
            "PRINT LV3",
            "LV4 = 0",
            "_SHOW",
            "PRINT " + ",".join(self._sample(k) for k in range(PER_LINE)),
            f"LV4 = LV4 + {PER_LINE}",
            f"IF (LV4 < {count}) THEN GOTO SHOW",
            "ENDP",
        ]
        return "\n".join(lines) + "\n"

    def _room(self, count: int, period_s: float) -> list[str]:
        """Lines that dimension what the program needs."""
        points = cam_sweep.points(self.duration_s, period_s) + 1
        return [
            *("DIM LV(8)", f"DIM SV({len(GAINS)})", "DIM DV(2)"),
            *(f"DIM LA({3 if self.is_cam else 2})", f"DIM LA0({count})", f"DIM LA1({count})"),
            *([f"DIM LA2({points})"] if self.is_cam else []),
            *("DIM SA(1)", f"DIM SA0({count})", "SAMP CLEAR"),
        ]

    def _table(self, axis: int, period_s: float) -> list[str]:
        """Lines that make the cam, where there is one."""
        if not self.is_cam:
            return []
        sweep = (self.height_cnt, self.low_hz, self.high_hz, self.duration_s, period_s)
        return [
            *cam_sweep.table_lines(*sweep),
            *cam_sweep.cam_lines(axis, self.duration_s, period_s),
        ]

    def _begin(self, axis: int, actual: str) -> list[str]:
        """Lines that start a cam: a card refuses it for an axis that is killed."""
        if not self.is_cam:
            return []
        watch = self._watch(axis, actual)
        return [*watch, "IF (LV3 <> 0) THEN GOTO BACK", f"AXIS{axis} CAM ON"]

    def _drive(self, axis: int, written: str) -> list[str]:
        """Lines of a round that move the axis, until the excitation is over."""
        if self.is_cam:
            return [f"IF (BIT{cam_sweep.flag(axis)}) THEN GOTO MOVE"]
        return [
            f"DV0 = ({CLOCK} - LV2) * 0.001",
            f"{written} = LV0 + {self._height()}",
            f"IF (DV0 < {self.duration_s:g}) THEN GOTO MOVE",
        ]

    def _height(self) -> str:
        """The offset at the time DV0; a sweep from low to high frequency."""
        if self.kind == "step":
            return f"{self.height_cnt:.0f}"
        bend = (self.high_hz - self.low_hz) / (2.0 * self.duration_s)
        return f"{self.height_cnt:g} * SIN(360 * DV0 * ({self.low_hz:g} + {bend:.9g} * DV0))"

    def _watch(self, axis: int, actual: str) -> list[str]:
        error = f"P{axes.following_error[axis]}"
        return [
            f"IF (ABS({error}) > {self.error_cnt:.0f}) THEN LV3 = 1",
            f"IF (ABS({actual} - LV1) > {self.travel_cnt:.0f}) THEN LV3 = 2",
            f"IF (BIT{KILL_FLAG + FLAGS_PER_AXIS * axis}) THEN LV3 = 3",
        ]

    @staticmethod
    def _sample(place: int) -> str:
        index = f"LV4 + {place}" if place else "LV4"
        return f"LA0({index}),LA1({index}),SA0({index})"

    def ending(self, code: int) -> str:
        """What a reason to end means; empty for none."""
        text = ENDS.get(code, "")
        return text.format(error=self.error_cnt, travel=self.travel_cnt)
