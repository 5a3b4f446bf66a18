"""Aries drives: status, error log and settings.

A drive measures the counts and the speed of its motor, the command voltage, and its enable
input. Its position error is the following error of the axis. A fault, a position error
beyond SMPER, wrong temperatures and a wrong bus voltage are its errors; those selected by
ERRORL are logged. Its serial protocol is in `aries_port`.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

from openacr.map import numbers as at
from openacr.map.memory import Memory
from openacr.map.rows import axes
from openacr.plant.bus import NEVER_S, now_s

ARIES = 1
TORQUE, VELOCITY = 2, 4  # DMODE
HOTTEST_DRIVE_C, HOTTEST_MOTOR_C = 80.0, 125.0
LOWEST_BUS_V, HIGHEST_BUS_V = 100.0, 400.0


class Errors(IntEnum):
    """Errors of a drive: bits of TASX and of ERRORL."""

    FAULT = 0
    POSITION = 1
    DRIVE_TEMPERATURE = 2
    MOTOR_TEMPERATURE = 3
    UNDERVOLTAGE = 4
    OVERVOLTAGE = 5


ERROR_TEXTS = (
    "DRIVE FAULT",
    "POSITION ERROR",
    "DRIVE TEMPERATURE",
    "MOTOR TEMPERATURE",
    "BUS UNDERVOLTAGE",
    "BUS OVERVOLTAGE",
)


@dataclass(frozen=True, slots=True)
class Drive:
    """The rows of the drive and the motor of one axis."""

    memory: Memory
    axis: int

    def real(self, row: int) -> float:
        """Read a row of the drive."""
        return self.memory.F[at.BUSDF_BASE + self.axis * at.BUSDF_STRIDE + row]

    def put_real(self, row: int, value: float) -> None:
        """Write a row of the drive."""
        self.memory.F[at.BUSDF_BASE + self.axis * at.BUSDF_STRIDE + row] = value

    def whole(self, row: int) -> int:
        """Read a row of the drive."""
        return self.memory.I[at.BUSDI_BASE + self.axis * at.BUSDI_STRIDE + row]

    def put_whole(self, row: int, value: int) -> None:
        """Write a row of the drive."""
        self.memory.I[at.BUSDI_BASE + self.axis * at.BUSDI_STRIDE + row] = value

    def setting(self, index: int) -> float:
        """Read a setting."""
        return self.real(at.BUSDF_SETTINGS + index)

    def motor(self, row: int) -> float:
        """Read a row of the motor."""
        return self.memory.F[at.PLF_BASE + self.axis * at.PLF_STRIDE + row]

    def motor_int(self, row: int) -> int:
        """Read a row of the motor."""
        return self.memory.I[at.PLI_BASE + self.axis * at.PLI_STRIDE + row]

    @property
    def powered_s(self) -> float | None:
        """Time of the latest power-up; None without power."""
        now, powered = now_s(self.memory), self.real(at.BUSDF_POWERED_S)
        if now >= self.real(at.BUSDF_BACK_S):
            powered = self.real(at.BUSDF_BACK_S)
        elif now >= self.real(at.BUSDF_LOST_S):
            return None
        return powered if now >= powered else None

    @property
    def hears(self) -> bool:
        """Whether the drive listens to the line: it must be connected before it is powered up."""
        powered_s = self.powered_s
        return powered_s is not None and self.real(at.BUSDF_CONNECTED_S) <= powered_s < NEVER_S


def drives(memory: Memory) -> list[Drive]:
    """All drives with a serial port."""
    found = (Drive(memory, axis) for axis in range(at.BUSD_COUNT))
    return [drive for drive in found if drive.whole(at.BUSDI_KIND) == ARIES]


# status


def _speed(drive: Drive, counts_per_s: float) -> float:
    return counts_per_s / max(drive.setting(ERES), 1.0)


def commanded_speed(drive: Drive) -> float:
    """The speed commanded by the voltage of a velocity drive [rev/s]."""
    return _speed(drive, drive.motor(at.PLF_VOLTS) * drive.motor(at.PLF_SPEED_PER_VOLT_CPS))


def speed_error(drive: Drive) -> float:
    """Commanded minus actual speed of a velocity drive [rev/s]."""
    has_velocity = drive.motor(at.PLF_SPEED_PER_VOLT_CPS) != 0.0
    return commanded_speed(drive) - velocity(drive) if has_velocity else 0.0


def velocity(drive: Drive) -> float:
    """Actual speed of the motor [rev/s]."""
    return _speed(drive, drive.motor(at.PLF_VELOCITY_CPS))


def current(drive: Drive) -> float:
    """The current commanded by the voltage of a torque drive [A]."""
    peak = drive.setting(DMTIP)
    return min(max(drive.motor(at.PLF_VOLTS) * drive.setting(DMTSCL), -peak), peak)


def torque(drive: Drive) -> float:
    """The commanded torque of a torque drive, in percent of its peak."""
    peak = drive.setting(DMTIP)
    return 100.0 * current(drive) / peak if peak else 0.0


def following_error(drive: Drive) -> int:
    """The position error: that of the axis of the card."""
    return drive.memory.I[axes.following_error[drive.axis]]


def commanded(drive: Drive) -> int:
    """The commanded position in counts."""
    reals = at.AXF_BASE + drive.axis * at.AXF_STRIDE
    return round(drive.memory.F[reals + at.AXF_SSP_CNT])


def age_s(drive: Drive) -> int:
    """Seconds since the drive was powered up."""
    return int(now_s(drive.memory) - (drive.powered_s or 0.0))


def is_enabled(drive: Drive) -> bool:
    """Whether the drive is enabled."""
    return bool(drive.motor_int(at.PLI_DRIVE_READY))


def errors(drive: Drive) -> int:
    """The present errors, as bits."""
    limit = drive.setting(SMPER)
    temperature, bus_v = drive.real(at.BUSDF_DRIVE_TEMP_C), drive.real(at.BUSDF_BUS_V)
    found = {
        Errors.FAULT: bool(drive.motor_int(at.PLI_DRIVE_FAULT)),
        Errors.POSITION: 0.0 < limit < abs(following_error(drive)),
        Errors.DRIVE_TEMPERATURE: temperature > HOTTEST_DRIVE_C,
        Errors.MOTOR_TEMPERATURE: drive.real(at.BUSDF_MOTOR_TEMP_C) > HOTTEST_MOTOR_C,
        Errors.UNDERVOLTAGE: bus_v < LOWEST_BUS_V,
        Errors.OVERVOLTAGE: bus_v > HIGHEST_BUS_V,
    }
    return sum(1 << error for error, is_present in found.items() if is_present)


def status(drive: Drive) -> int:
    """Status bits of TAS: 0 enabled, 1 moving, 2 in the negative direction, 3 any error."""
    speed = drive.motor(at.PLF_VELOCITY_CPS)
    bits = (is_enabled(drive), speed != 0.0, speed < 0.0, errors(drive) != 0)
    return sum(1 << bit for bit, is_set in enumerate(bits) if is_set)


# the error log


def notice_errors(drive: Drive) -> None:
    """Log new errors that are selected; the oldest of eight entries is dropped."""
    now = errors(drive)
    new = now & ~drive.whole(at.BUSDI_ERRORS) & drive.whole(at.BUSDI_SELECTION)
    drive.put_whole(at.BUSDI_ERRORS, now)
    for error in Errors:
        if new >> error & 1:
            count = drive.whole(at.BUSDI_LOG_COUNT)
            place = count % at.BUSDI_LOG_ERROR_SIZE
            drive.put_whole(at.BUSDI_LOG_ERROR + place, error)
            drive.put_real(at.BUSDF_LOG_S + place, age_s(drive))
            drive.put_whole(at.BUSDI_LOG_COUNT, count + 1)


def log(drive: Drive) -> list[str]:
    """The entries of the log, the oldest first."""
    count, size = drive.whole(at.BUSDI_LOG_COUNT), at.BUSDI_LOG_ERROR_SIZE
    places = [entry % size for entry in range(max(count - size, 0), count)]
    return [
        f"{_clock(drive.real(at.BUSDF_LOG_S + place))} "
        f"{ERROR_TEXTS[drive.whole(at.BUSDI_LOG_ERROR + place)]}"
        for place in places
    ]


def _clock(seconds: float) -> str:
    minutes, rest = divmod(int(seconds), 60)
    return f"{minutes // 60}:{minutes % 60:02d}:{rest:02d}"


# settings


@dataclass(frozen=True, slots=True)
class Setting:
    """A setting; `row` of the motor is proportional to it, None: no effect on the motor."""

    word: str
    highest: float
    motor_row: int | None = None


SETTINGS = (
    Setting("DMODE", 0.0),  # determined by the type of drive
    Setting("ERES", 1e9),
    Setting("SMPER", 2147483647.0),
    Setting("DMTIP", 1e4, at.PLF_PEAK_ACCEL),
    Setting("DMTSCL", 1e4, at.PLF_ACCEL_PER_VOLT),
    Setting("DMVSCL", 1e4, at.PLF_SPEED_PER_VOLT_CPS),
)
SMALLEST_SCALE = 0.001
DMODE, ERES, SMPER, DMTIP, DMTSCL, DMVSCL = range(len(SETTINGS))


def change_setting(drive: Drive, index: int, value: float) -> bool:
    """Change a setting, and the motor with it; False if the drive cannot."""
    setting, present = SETTINGS[index], drive.setting(index)
    if value == present:
        return True
    if not 0.0 <= value <= setting.highest:
        return False
    if setting.motor_row is not None:
        if not present or value < SMALLEST_SCALE:
            return False  # this kind of drive lacks it
        row = at.PLF_BASE + drive.axis * at.PLF_STRIDE + setting.motor_row
        drive.memory.F[row] *= value / present
    drive.put_real(at.BUSDF_SETTINGS + index, value)
    return True
