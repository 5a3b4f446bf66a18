"""The motors of emulated drives: those of a machine, with the loops that a bus drive closes itself.

A drive of `machine.toml` takes volts; here its bus drive gives them, once in a servo period:

    speed wanted  = feed-forward + POSITION x position error
    acceleration  = feed-forward + SPEED x (speed error + its integral x INTEGRAL)

POSITION, SPEED and INTEGRAL are in 1/s and follow from the servo period, so that every motor of a
machine is followed well, whatever its inertia.
"""

from openacr import compiled
from openacr.errors import UserError
from openacr.map.memory import Memory
from openacr.map.rows import dacs, motors
from openacr.plant.build.apply import accel_per_nm, apply_world
from openacr.plant.describe.schema import (
    Axis,
    Contact,
    ExactDrive,
    IdealDrive,
    PhaseDrive,
    TorqueDrive,
    VelocityDrive,
    World,
    switches,
)
from openacr.plant.inputs import input_place
from openacr.plant.physics.step_cy import plant_step

_STEP = compiled.pick(plant_step)
HIGHEST_VOLTS = 10.0
OVERLOAD = 3.0  # peak torque of a drive: times its rated torque
PERMILLE = 1000.0
_SPEED, _POSITION, _INTEGRAL = 0.3, 0.05, 0.02  # per servo period
_DEADBAND_CNT = 0.5


class Plant:
    """All motors of a machine, and their time."""

    def __init__(self, world: World) -> None:
        self.world = world
        self.memory = Memory()
        apply_world(world, self.memory)
        self.period_s = world.card.period_s
        self.period_ns = round(world.card.period_s * 1e9)
        self._axes = max((axis.number for axis in world.axis), default=-1) + 1

    def step(self) -> None:
        """One servo period of the world."""
        memory = self.memory
        _STEP(memory.F, memory.I, memory.S, self._axes, self.period_s)


class Motor:
    """One motor with its encoder and its switches, in counts and seconds."""

    def __init__(self, plant: Plant, axis: Axis) -> None:
        drive = axis.drive
        if not isinstance(drive, TorqueDrive | VelocityDrive | IdealDrive | ExactDrive) or (
            isinstance(drive, PhaseDrive)
        ):
            raise UserError(
                f"axis {axis.label}: its drive has no counterpart on a bus; those with "
                'mode = "torque", "velocity", "ideal" or "exact" have'
            )
        self.axis = axis
        self._memory = plant.memory
        self.period_s = plant.period_s
        self._dac = axis.number if axis.dac is None else axis.dac
        self._position = motors.position_cnt[axis.number]
        self._velocity = motors.velocity_cps[axis.number]
        self._enabled = motors.drive_enabled[axis.number]
        self._per_volt = self._memory.F[motors.accel_per_volt[axis.number]]
        self._speed_per_volt = self._memory.F[motors.speed_per_volt_cps[axis.number]]
        self._lag_s = self._memory.F[motors.lag_s[axis.number]]
        self.has_torque = isinstance(drive, TorqueDrive)
        self._is_exact = isinstance(drive, ExactDrive)
        self.peak_accel = self._memory.F[motors.peak_accel[axis.number]]
        per_nm = accel_per_nm(axis) if axis.motor is not None else 0.0
        self._per_permille = self.peak_accel / OVERLOAD / PERMILLE
        self.rated_nm = self.peak_accel / OVERLOAD / per_nm if per_nm else 0.0
        self._integral = 0.0
        self._old_velocity = 0.0
        self.jumped_cnt = 0  # what the encoder reports too much
        self.torque_permille = 0
        self.is_limited = False
        self.switches = [
            (each.key, *input_place(each.input), each.contact is Contact.CLOSED)
            for each in switches(axis)
        ]
        self.stop()

    @property
    def position_cnt(self) -> float:
        """Where the encoder says the motor is."""
        return self._memory.F[self._position] + self.jumped_cnt

    @property
    def velocity_cps(self) -> float:
        """Its speed; of an exact drive that of the last period."""
        return self._old_velocity if self._is_exact else self._memory.F[self._velocity]

    def is_active(self, key: str) -> bool:
        """Whether a switch is active: "positive_limit", "negative_limit" or "home"."""
        for name, word, mask, is_closed in self.switches:
            if name == key:
                return bool(self._memory.I[word] & mask) != is_closed
        return False

    def enable(self) -> None:
        """Give it current from now on."""
        self._integral = 0.0
        self._memory.I[self._enabled] = 1

    def stop(self) -> None:
        """Take its current away: it coasts."""
        self._memory.I[self._enabled] = 0
        self._volts(0.0)
        self._integral = 0.0
        self._old_velocity = 0.0
        self.torque_permille = 0
        self.is_limited = False

    def follow(
        self, position_cnt: float, velocity_cps: float, accel: float, limit_permille: float
    ) -> None:
        """Close the loop for one period: to a position, with speed and acceleration beside it."""
        error = position_cnt - self.position_cnt
        if self._is_exact:
            self._place(error)
        elif self.has_torque:
            wanted = velocity_cps + _POSITION / self.period_s * error
            rests = velocity_cps == 0.0 and abs(error) <= _DEADBAND_CNT
            self._turn(wanted, accel, limit_permille, rests)
        else:
            gain = 1.0 / (4.0 * (self._lag_s + self.period_s))
            self._speed(velocity_cps + gain * error)

    def turn(self, velocity_cps: float, accel: float, limit_permille: float) -> None:
        """Close the loop for one period: to a speed."""
        if self._is_exact:
            self._place(velocity_cps * self.period_s)
        elif self.has_torque:
            self._turn(velocity_cps, accel, limit_permille, False)
        else:
            self._speed(velocity_cps)

    def push(self, permille: float, limit_permille: float) -> None:
        """Give a torque for one period, in thousandths of the rated torque."""
        self._accelerate(permille * self._per_permille, limit_permille)

    def _turn(self, velocity_cps: float, accel: float, limit: float, rests: bool) -> None:
        error = velocity_cps - self.velocity_cps
        gain = _SPEED / self.period_s
        if not rests and not self.is_limited:
            self._integral += error * _INTEGRAL
        self._accelerate(accel + gain * (error + self._integral), limit)

    def _accelerate(self, accel: float, limit_permille: float) -> None:
        most = min(limit_permille * self._per_permille, self.peak_accel)
        given = max(-most, min(most, accel))
        self.is_limited = given != accel
        self.torque_permille = round(given / self._per_permille)
        self._volts(given / self._per_volt)

    def _speed(self, velocity_cps: float) -> None:
        self._volts(velocity_cps / self._speed_per_volt)

    def _place(self, by_cnt: float) -> None:
        self._memory.F[self._position] += by_cnt
        self._old_velocity = by_cnt / self.period_s

    def _volts(self, volts: float) -> None:
        limited = max(-HIGHEST_VOLTS, min(HIGHEST_VOLTS, volts))
        self._memory.S[dacs.dac_output[self._dac]] = limited
