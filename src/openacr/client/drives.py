"""The drives of a card: what each is, what its fault is, what bars it from being enabled.

All is read as any host may read it, so that it is the same for a virtual card, a served one and a
real one. What an encoder reports counts for the axis of the same number.
"""

from collections.abc import Callable, Sequence

from msgspec import Struct

from openacr.map.numbers import W_MISC_CONTROL_1
from openacr.map.rows import axes
from openacr.map.words import af1, af4, af5, ef

ENABLE_S = 0.5  # longest time from DRIVE ON to the flag; a card takes 10 ms
MEI_RESET = 5647  # flag: Motion Enable Latch Reset Request
MEI_LATCHED, MEI_OPEN = 1 << 13, 1 << 14
WORDS = (af1.word, af4.word, af5.word)
VALUES = (
    axes.ppu, axes.primary_setpoint, axes.actual_position, axes.following_error,
    axes.plus_excess_error, axes.minus_excess_error, axes.output_signal, axes.plus_torque_limit,
    axes.minus_torque_limit,
)  # fmt: skip
BROKEN = ef.ENCODER_SIGNAL_FAULT | ef.ENCODER_SIGNAL_LOST
OFFSETS = af1.JOG_ACTIVE | af1.GEAR_ACTIVATE | af1.GEAR_ACTIVE | af1.CAM_ACTIVATE

TEXTS = {  # of what is wrong; {0}: the number of the axis
    "enable.open": "the Motion Enable Input is open: 24 V are missing",
    "enable.latched": "the Motion Enable Input was open: RESET clears its latch",
    "input": "the drive reports a fault at its fault input",
    "encoder": "encoder ENC{0} has a signal fault: ENC{0} RES clears it once the signal is back",
    "fault": "a drive fault is latched: RESET clears it",
    "excess": "the following error was beyond its limit: DRIVE ON takes the position over",
    "killed": "the motion of the axis is killed: DRIVE ON lifts that",
    "hard.plus": "the positive limit switch was reached: DRIVE ON clears the latch",
    "hard.minus": "the negative limit switch was reached: DRIVE ON clears the latch",
    "soft.plus": "the positive software limit was reached: DRIVE ON clears the latch",
    "soft.minus": "the negative software limit was reached: DRIVE ON clears the latch",
}
BARS = ("enable.open", "enable.latched", "input", "encoder")  # DRIVE ON does not help
LIMITS = {
    "hard.plus": af5.POSITIVE_HARDWARE_LIMIT_ENCOUNTERED,
    "hard.minus": af5.NEGATIVE_HARDWARE_LIMIT_ENCOUNTERED,
    "soft.plus": af5.POSITIVE_SOFTWARE_LIMIT_ENCOUNTERED,
    "soft.minus": af5.NEGATIVE_SOFTWARE_LIMIT_ENCOUNTERED,
}


class Drive(Struct, frozen=True):
    """One axis as it was read; lengths in its units, the output in V.

    `has_io`: its enable output is used; without it an axis that was never switched off is driven.
    `wrong` are keys of TEXTS, those of BARS first.
    """

    axis: int
    is_enabled: bool
    has_io: bool
    is_jogged: bool
    is_homed: bool
    wrong: tuple[str, ...]
    ppu: float
    setpoint_u: float
    actual_u: float
    following_u: float
    plus_error_u: float
    minus_error_u: float
    output_v: float
    plus_output_v: float
    minus_output_v: float

    @property
    def bars(self) -> list[str]:
        """What keeps the drive from being enabled, in words."""
        return [said(each, self.axis) for each in self.wrong if each in BARS]


def said(wrong: str, axis: int) -> str:
    """What is wrong with the drive of an axis, in words."""
    return TEXTS[wrong].format(axis)


def read_drives(read: Callable[[list[int]], list[float]], wanted: Sequence[int]) -> list[Drive]:
    """The drives of some axes; `read` reads parameters of the card, with one request."""
    rows = (*WORDS, ef.word, *VALUES)
    values = read([W_MISC_CONTROL_1, *(row[axis] for axis in wanted for row in rows)])
    common, count = int(values[0]), len(rows)
    return [
        _drive(axis, common, values[1 + n * count : 1 + (n + 1) * count])
        for n, axis in enumerate(wanted)
    ]


def _drive(axis: int, common: int, values: list[float]) -> Drive:
    moved, flags, limits, encoder = map(int, values[:4])
    ppu, *lengths = values[4:10]
    has_io = bool(flags & af4.DRIVE_I_O_ENABLE)
    is_active = bool(flags & af4.DRIVE_FAULT_INPUT)
    is_inverted = bool(flags & af4.DRIVE_FAULT_LEVEL_INVERT)
    found = {
        "enable.open": common & MEI_OPEN,
        "enable.latched": common & MEI_LATCHED and not common & MEI_OPEN,
        "input": has_io and is_active != is_inverted,
        "encoder": encoder & BROKEN,
        "fault": flags & af4.DRIVE_FAULT,
        "excess": flags & af4.EXCESS_ERROR_FAULT,
        "killed": flags & af4.KILL_ALL_MOTION_REQUEST,
        **{name: limits & mask for name, mask in LIMITS.items()},
    }
    scale = ppu or 1.0
    return Drive(
        axis,
        bool(flags & af4.DRIVE_ENABLED),
        has_io,
        bool(moved & OFFSETS),
        bool(limits & af5.HOME_SUCCESSFUL),
        tuple(name for name, is_so in found.items() if is_so),
        ppu,
        *(length / scale for length in lengths[:3]),
        *values[8:10],
        *values[10:13],
    )
