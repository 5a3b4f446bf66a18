"""An emulated drive of the profile CiA 402 with a motor of a machine.

Modes: cyclic synchronous position, velocity and torque, and homing to where it is. All is in
counts of the motor's encoder and seconds; torques are thousandths of the rated torque.
"""

import math

from openacr.fieldbus.ethercat.emulated.drive_objects import DriveObjects, drive_description
from openacr.fieldbus.ethercat.emulated.motor import Motor
from openacr.fieldbus.ethercat.emulated.probe import Probe
from openacr.fieldbus.ethercat.emulated.profile import HALT, POWERED, DriveState, Profile
from openacr.fieldbus.ethercat.emulated.slave import COMMUNICATION_ERROR, Slave
from openacr.fieldbus.ethercat.wire import sii
from openacr.fieldbus.ethercat.wire.registers import AlCode

HOMING, CSP, CSV, CST = 6, 8, 9, 10
HOME_HERE = (35, 37)  # methods of homing that take the present position
FOLLOWING_ERROR, BUS_ERROR, DRIVE_ERROR = 0x8611, 0x7500, 0xFF01
GENERIC, MOTION = 0x01, 0x20  # bits of the error register
_VOLTAGE_BIT, _REMOTE_BIT = 0x10, 0x200
_REACHED, _LIMITED, _FOLLOWS, _TOO_FAR = 0x400, 0x800, 0x1000, 0x2000
_HOMED = 0x1000
STANDSTILL_CPS = 1.0
_MIDDLE = 0.5  # of a count


class Drive(Slave):
    """One drive; `fail` of a drive is a fault of the drive, not of the bus."""

    device_type = 0x00020192  # servo drive, profile 402

    def __init__(
        self, motor: Motor, name: str, alias: int = 0, description: sii.Description | None = None
    ) -> None:
        self.motor = motor
        self.profile = Profile()
        self.modes = (HOMING, CSP, CSV, CST) if motor.has_torque else (HOMING, CSP, CSV)
        self._period_s = 0.0
        self._demand = 0.0  # position
        self._speed = 0.0  # that is demanded
        self._target = 0.0  # where the demand will be once the cycle is over
        self._left_s = 0.0  # of the present cycle
        self._late_s = 0.0  # how long the following error has been too large
        self._home_cnt = 0
        self._is_homed = False
        self._is_held = False  # a cause of a fault that is still there
        super().__init__(description or drive_description(motor.axis.number + 1, alias), name)

    def add_objects(self) -> None:
        """The objects of the profile."""
        self.objects = DriveObjects(self.dictionary, self.motor, self.modes)
        self.probe = Probe(self.objects, self.motor)
        self.profile.start()
        self._report()

    # -- process data ------------------------------------------------------------------------

    def outputs_changed(self) -> None:
        """A new cycle begins: the demand moves evenly to the target in it."""
        cycle_s = self.controller.clock.cycle_ns * 1e-9 or self.objects.cycle_s
        if self.objects.mode_shown.number == CSP:
            wanted = self.objects.target_position.number
            now = math.floor(self._target)
            self._target = now + (wanted - self._home_cnt - now + 2**31) % 2**32 - 2**31 + _MIDDLE
            self._left_s = cycle_s

    def inputs_wanted(self) -> None:
        """Write what is measured into the objects."""
        self._report()

    def outputs_off(self, code: AlCode) -> None:
        """Without outputs a drive that has power stops with a fault."""
        if not self.is_powered:
            self._switch_off(DriveState.NOT_READY)
        elif self.profile.state in POWERED:
            self.fault(BUS_ERROR, COMMUNICATION_ERROR | GENERIC)
        self.objects.control.value = 0

    def restarted(self) -> None:
        """Power is back: mode and targets are as at the start."""
        self.profile = Profile()
        self.profile.start()
        self._is_homed = self._is_held = False
        self.objects.reset()
        self._report()

    def shown(self) -> str:
        """State, error and position."""
        error = self.objects.error.number
        text = f"{self.profile.state.name} at {math.floor(self.motor.position_cnt)}"
        return f"{text}, error 0x{error:04X}" if error else text

    # -- faults ------------------------------------------------------------------------------

    def fault(self, code: int = DRIVE_ERROR, register: int = GENERIC, held: bool = False) -> None:
        """A fault: the drive stops by its quick stop ramp, then its power is off.

        `held`: the cause stays until `mend`.
        """
        self._is_held = self._is_held or held
        if self.profile.state in (DriveState.FAULT, DriveState.REACTION):
            return
        self.objects.error.value = code
        self.error_register.value = register
        self.emergency(code, register)
        if self.profile.state in POWERED:
            self._begin_stop()
            self.profile.state = DriveState.REACTION
        else:
            self._switch_off(DriveState.FAULT)

    def mend(self) -> None:
        """The cause of a fault is gone: it can be reset."""
        self._is_held = False

    def jump(self, by_cnt: int) -> None:
        """Make the encoder report this number of counts too much."""
        self.motor.jumped_cnt += by_cnt

    # -- a period ----------------------------------------------------------------------------

    def step(self, now: int) -> None:
        """One servo period: state machine, loop, touch probe."""
        if not self.is_powered:
            return
        one = self.objects
        dt = self.motor.period_s
        self.probe.watch(self._home_cnt)
        if one.mode.number in self.modes:
            one.mode_shown.value = one.mode.value
        self._change_state()
        state = self.profile.state
        if state is DriveState.ENABLED:
            self._run(dt)
            self._check_following(dt)
        elif state in POWERED:
            self._ramp_down(dt)

    def _change_state(self) -> None:
        was = self.profile.state
        one = self.objects
        if was is DriveState.REACTION:
            return
        self.profile.obey(one.control.number, not self._is_held, one.quick_option.number >= 5)
        state = self.profile.state
        if state is was:
            return
        if state is DriveState.ENABLED and was is not DriveState.QUICK_STOP:
            self._take_over()
            self.motor.enable()
        elif state is DriveState.ENABLED:
            self._take_over()
        elif state is DriveState.QUICK_STOP:
            self._begin_stop()
        elif was in POWERED:
            self._switch_off(state)
        if was is DriveState.FAULT:
            one.error.value = 0
            self.error_register.value = 0

    def _take_over(self) -> None:
        """Start from where the motor is."""
        self._demand = self._target = math.floor(self.motor.position_cnt) + _MIDDLE
        self._speed = self._left_s = self._late_s = 0.0
        if self.objects.mode_shown.number == CSP:
            self.outputs_changed()

    def _switch_off(self, state: DriveState) -> None:
        self.motor.stop()
        self.profile.state = state
        self._speed = 0.0

    def _run(self, dt: float) -> None:
        one = self.objects
        mode = one.mode_shown.number
        limit = one.torque_limit
        if one.control.number & HALT:
            self._ramp(dt, one.quick_deceleration.number)
        elif mode == CST:
            self.motor.push(one.target_torque.number + one.torque_offset.number, limit)
            self._demand = self._target = self.motor.position_cnt
            self._speed = self.motor.velocity_cps
        elif mode == CSV:
            speed = one.target_velocity.number + one.velocity_offset.number
            self._speed = float(speed)
            self.motor.turn(self._speed, 0.0, limit)
            self._demand = self._target = self.motor.position_cnt
        else:
            if mode == HOMING:
                self._home()
            self._interpolate(dt)
            self.motor.follow(self._demand, self._speed, self._accel, limit)

    def _interpolate(self, dt: float) -> None:
        """Move the demand evenly, so that it is on the target at the end of the cycle."""
        before = self._speed
        if self._left_s > dt / 2:
            part = min(1.0, dt / self._left_s)
            self._speed = (self._target - self._demand) * part / dt
            self._demand += self._speed * dt
            self._left_s -= dt
        else:
            self._demand, self._speed = self._target, 0.0
        self._accel = (self._speed - before) / dt

    def _home(self) -> None:
        """Methods 35 and 37: the present position becomes the home offset."""
        one = self.objects
        starts = one.control.number & 0x10
        if not starts:
            self._is_homed = False
        elif not self._is_homed and one.homing_method.number in HOME_HERE:
            here = math.floor(self.motor.position_cnt)
            self._home_cnt = one.home_offset.number - here
            self._is_homed = True

    def _begin_stop(self) -> None:
        self._demand = self.motor.position_cnt
        self._speed = self.motor.velocity_cps

    def _ramp_down(self, dt: float) -> None:
        """Quick stop or fault reaction: down to standstill, then what the option says."""
        one = self.objects
        is_fault = self.profile.state is DriveState.REACTION
        option = one.fault_option.number if is_fault else one.quick_option.number
        if option == 0:
            self._speed = 0.0
        else:
            self._ramp(dt, one.quick_deceleration.number)
        if option == 0 or abs(self._speed) < STANDSTILL_CPS:
            if is_fault:
                self._switch_off(DriveState.FAULT)
            elif option < 5:
                self._switch_off(DriveState.DISABLED)

    def _ramp(self, dt: float, deceleration: float) -> None:
        change = min(abs(self._speed), deceleration * dt)
        accel = -math.copysign(change, self._speed) / dt
        self._demand += self._speed * dt - math.copysign(change, self._speed) * dt / 2
        self._speed += accel * dt
        self._target = self._demand
        self.motor.follow(self._demand, self._speed, accel, self.objects.torque_limit)

    def _check_following(self, dt: float) -> None:
        one = self.objects
        window = one.following_window.number
        is_far = window != 0xFFFFFFFF and abs(self._demand - self.motor.position_cnt) > window
        self._late_s = self._late_s + dt if is_far else 0.0
        if is_far and self._late_s * 1000 > one.following_time.number:
            self.fault(FOLLOWING_ERROR, MOTION | GENERIC)

    # -- what is shown -----------------------------------------------------------------------

    def _report(self) -> None:
        one, motor = self.objects, self.motor
        position = math.floor(motor.position_cnt)
        one.position.value = _wrap(position + self._home_cnt)
        one.velocity.value = _wrap(round(motor.velocity_cps))
        one.torque.value = max(-32768, min(32767, motor.torque_permille))
        one.following_error.value = _wrap(round(self._demand - motor.position_cnt))
        one.show_inputs()
        one.status.value = self._status()

    def _status(self) -> int:
        one, state = self.objects, self.profile.state
        bits = state | _VOLTAGE_BIT | _REMOTE_BIT
        if self.motor.is_limited:
            bits |= _LIMITED
        if state is DriveState.ENABLED:
            mode = one.mode_shown.number
            if mode in (CSP, CSV, CST) and not one.control.number & HALT:
                bits |= _FOLLOWS
            elif mode == HOMING and self._is_homed:
                bits |= _HOMED | _REACHED
            if self._late_s:
                bits |= _TOO_FAR
        return bits


def _wrap(value: int) -> int:
    return (value + 2**31) % 2**32 - 2**31
