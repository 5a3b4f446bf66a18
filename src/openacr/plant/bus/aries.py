"""Aries drives: status, error log and settings.

A drive measures the counts and the speed of its motor, the command voltage, and its enable
input. Its position error is the following error of the axis. A fault, a position error
beyond SMPER, wrong temperatures and a wrong bus voltage are its errors; those selected by
ERRORL are logged. Its serial protocol is in `aries_port`.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

from openacr.map.memory import Memory
from openacr.map.rows import axes, bus_drives, motors
from openacr.plant.bus.bus import NEVER_S, now_s

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

    def real(self, row: tuple[int, ...], place: int = 0) -> float:
        """Read a row of the drive, or one place of an array row."""
        return self.memory.F[row[self.axis] + place]

    def put_real(self, row: tuple[int, ...], value: float, place: int = 0) -> None:
        """Write a row of the drive, or one place of an array row."""
        self.memory.F[row[self.axis] + place] = value

    def whole(self, row: tuple[int, ...], place: int = 0) -> int:
        """Read a row of the drive, or one place of an array row."""
        return self.memory.I[row[self.axis] + place]

    def put_whole(self, row: tuple[int, ...], value: int, place: int = 0) -> None:
        """Write a row of the drive, or one place of an array row."""
        self.memory.I[row[self.axis] + place] = value

    def setting(self, index: int) -> float:
        """Read a setting."""
        return self.real(bus_drives.settings, index)

    def motor(self, row: tuple[int, ...]) -> float:
        """Read a row of the motor."""
        return self.memory.F[row[self.axis]]

    def motor_int(self, row: tuple[int, ...]) -> int:
        """Read a row of the motor."""
        return self.memory.I[row[self.axis]]

    @property
    def powered_s(self) -> float | None:
        """Time of the latest power-up; None without power."""
        now, powered = now_s(self.memory), self.real(bus_drives.powered_s)
        if now >= self.real(bus_drives.back_s):
            powered = self.real(bus_drives.back_s)
        elif now >= self.real(bus_drives.lost_s):
            return None
        return powered if now >= powered else None

    @property
    def hears(self) -> bool:
        """Whether the drive listens to the line: it must be connected before it is powered up."""
        powered_s = self.powered_s
        return powered_s is not None and self.real(bus_drives.connected_s) <= powered_s < NEVER_S


def drives(memory: Memory) -> list[Drive]:
    """All drives with a serial port."""
    found = (Drive(memory, axis) for axis in range(bus_drives.COUNT))
    return [drive for drive in found if drive.whole(bus_drives.kind) == ARIES]


# status


def _speed(drive: Drive, counts_per_s: float) -> float:
    return counts_per_s / max(drive.setting(ERES), 1.0)


def commanded_speed(drive: Drive) -> float:
    """The speed commanded by the voltage of a velocity drive [rev/s]."""
    return _speed(drive, drive.motor(motors.volts) * drive.motor(motors.speed_per_volt_cps))


def speed_error(drive: Drive) -> float:
    """Commanded minus actual speed of a velocity drive [rev/s]."""
    has_velocity = drive.motor(motors.speed_per_volt_cps) != 0.0
    return commanded_speed(drive) - velocity(drive) if has_velocity else 0.0


def velocity(drive: Drive) -> float:
    """Actual speed of the motor [rev/s]."""
    return _speed(drive, drive.motor(motors.velocity_cps))


def current(drive: Drive) -> float:
    """The current commanded by the voltage of a torque drive [A]."""
    peak = drive.setting(DMTIP)
    return min(max(drive.motor(motors.volts) * drive.setting(DMTSCL), -peak), peak)


def torque(drive: Drive) -> float:
    """The commanded torque of a torque drive, in percent of its peak."""
    peak = drive.setting(DMTIP)
    return 100.0 * current(drive) / peak if peak else 0.0


def following_error(drive: Drive) -> int:
    """The position error: that of the axis of the card."""
    return drive.memory.I[axes.following_error[drive.axis]]


def commanded(drive: Drive) -> int:
    """The commanded position in counts."""
    return round(drive.memory.F[axes.ssp_cnt[drive.axis]])


def age_s(drive: Drive) -> int:
    """Seconds since the drive was powered up."""
    return int(now_s(drive.memory) - (drive.powered_s or 0.0))


def is_enabled(drive: Drive) -> bool:
    """Whether the drive is enabled."""
    return bool(drive.motor_int(motors.drive_ready))


def errors(drive: Drive) -> int:
    """The present errors, as bits."""
    limit = drive.setting(SMPER)
    temperature, bus_v = drive.real(bus_drives.drive_temp_c), drive.real(bus_drives.bus_v)
    found = {
        Errors.FAULT: bool(drive.motor_int(motors.drive_fault)),
        Errors.POSITION: 0.0 < limit < abs(following_error(drive)),
        Errors.DRIVE_TEMPERATURE: temperature > HOTTEST_DRIVE_C,
        Errors.MOTOR_TEMPERATURE: drive.real(bus_drives.motor_temp_c) > HOTTEST_MOTOR_C,
        Errors.UNDERVOLTAGE: bus_v < LOWEST_BUS_V,
        Errors.OVERVOLTAGE: bus_v > HIGHEST_BUS_V,
    }
    return sum(1 << error for error, is_present in found.items() if is_present)


def status(drive: Drive) -> int:
    """Status bits of TAS: 0 enabled, 1 moving, 2 in the negative direction, 3 any error."""
    speed = drive.motor(motors.velocity_cps)
    bits = (is_enabled(drive), speed != 0.0, speed < 0.0, errors(drive) != 0)
    return sum(1 << bit for bit, is_set in enumerate(bits) if is_set)


# the error log


def notice_errors(drive: Drive) -> None:
    """Log new errors that are selected; the oldest of eight entries is dropped."""
    now = errors(drive)
    new = now & ~drive.whole(bus_drives.errors) & drive.whole(bus_drives.selection)
    drive.put_whole(bus_drives.errors, now)
    for error in Errors:
        if new >> error & 1:
            count = drive.whole(bus_drives.log_count)
            place = count % bus_drives.LOG_ERROR_SIZE
            drive.put_whole(bus_drives.log_error, error, place)
            drive.put_real(bus_drives.log_s, age_s(drive), place)
            drive.put_whole(bus_drives.log_count, count + 1)


def log(drive: Drive) -> list[str]:
    """The entries of the log, the oldest first."""
    count, size = drive.whole(bus_drives.log_count), bus_drives.LOG_ERROR_SIZE
    places = [entry % size for entry in range(max(count - size, 0), count)]
    return [
        f"{_clock(drive.real(bus_drives.log_s, place))} "
        f"{ERROR_TEXTS[drive.whole(bus_drives.log_error, place)]}"
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
    motor_row: tuple[int, ...] | None = None


SETTINGS = (
    Setting("DMODE", 0.0),  # determined by the type of drive
    Setting("ERES", 1e9),
    Setting("SMPER", 2147483647.0),
    Setting("DMTIP", 1e4, motors.peak_accel),
    Setting("DMTSCL", 1e4, motors.accel_per_volt),
    Setting("DMVSCL", 1e4, motors.speed_per_volt_cps),
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
        drive.memory.F[setting.motor_row[drive.axis]] *= value / present
    drive.put_real(bus_drives.settings, value, index)
    return True
