"""A sweep that the card plays from a cam table, one point in each servo period.

A program writes the jog offset about once a millisecond. A cam with the clock as its source
(1000 pulses a second) needs no program while it runs: the table has a point for each servo
interrupt, begins and ends with 0, and switches itself off at its end (CAM CYCLES 1).

The frequency grows with the square of the time, so that most of the time is spent where a motor
is identified; above KNEE_HZ the amplitude falls with the frequency, so that the speed stays.
"""

from openacr.map.rows import axes

KNEE_HZ = 60.0
PULSES_PER_S = 1000.0
CAM_FLAG, FLAGS_PER_AXIS = 790, 32  # Cam Activate of axis 0; distance to that of the next axis
DEG_PER_TURN = 360
PER_ROUND = 4  # points written in a round of the program


def points(duration_s: float, period_s: float) -> int:
    """Servo periods that the sweep lasts, in whole rounds; its table has one point more."""
    count = round(duration_s / period_s)
    return count - count % PER_ROUND


def table_lines(
    height_cnt: float, low_hz: float, high_hz: float, duration_s: float, period_s: float
) -> list[str]:
    """Lines that fill LA2; they use LV5, DV0 and DV1. The last point is 0, as the first."""
    count = points(duration_s, period_s)
    length_s = count * period_s
    turns = round(length_s * (2.0 * low_hz + high_hz) / 3.0)  # whole ones: it ends where it began
    bend = 3.0 * (turns / length_s - low_hz) / length_s**2  # Hz/s^2
    lines = ["LV5 = 0", "_FILL"]
    for place in range(PER_ROUND):
        index = f"LV5 + {place}" if place else "LV5"
        lines += [
            f"DV0 = ({index}) * {period_s:.9g}",
            f"DV1 = {low_hz:g} + {bend:.9g} * DV0 * DV0",
            f"IF (DV1 < {KNEE_HZ:g}) THEN DV1 = {KNEE_HZ:g}",
            f"LA2({index}) = {height_cnt * KNEE_HZ:.9g} / DV1"
            f" * SIN({DEG_PER_TURN} * DV0 * ({low_hz:g} + {bend / 3.0:.9g} * DV0 * DV0))",
        ]
    return [
        *lines,
        f"LV5 = LV5 + {PER_ROUND}",
        f"IF (LV5 < {count}) THEN GOTO FILL",
        f"LA2({count}) = 0",
    ]


def cam_lines(axis: int, duration_s: float, period_s: float) -> list[str]:
    """Lines that make LA2 the cam of an axis, all settings those of a cam without them.

    LV6 keeps CAM Velocity Smooth: feed-forward shall see the speed as it is.
    """
    smooth = smoothing(axis)
    length = points(duration_s, period_s) * period_s * PULSES_PER_S
    return [
        f"LV6 = {smooth}",
        f"{smooth} = 1",
        f"AXIS{axis} CAM CLEAR",
        f"AXIS{axis} CAM DIM 1",
        f"AXIS{axis} CAM SEG (0,{length:.9g},LA2)",
        f"AXIS{axis} CAM CYCLES 1",
    ]


def end_lines(axis: int) -> list[str]:
    """Lines that leave the axis without a cam, as it was."""
    return [f"AXIS{axis} CAM OFF", f"AXIS{axis} CAM CLEAR", f"{smoothing(axis)} = LV6"]


def flag(axis: int) -> int:
    """The flag of a cam that runs."""
    return CAM_FLAG + FLAGS_PER_AXIS * axis


def smoothing(axis: int) -> str:
    """CAM Velocity Smooth of an axis."""
    return f"P{axes.cam_velocity_smooth[axis]}"


def offset(axis: int) -> str:
    """Cam Offset of an axis."""
    return f"P{axes.cam_offset[axis]}"
