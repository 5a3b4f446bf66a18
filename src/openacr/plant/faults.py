"""Faults of the machine around the card, injected and removed while it runs.

All state is in the rows of the machine, so that snapshots, restarts of the card and replayed
journals include it. When a fault ends, the changed rows are rewritten from the machine file.
"""

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum

from openacr.errors import UserError
from openacr.map import numbers as at
from openacr.map.memory import Memory
from openacr.plant import apply, inputs
from openacr.plant.counts import count_of
from openacr.plant.drive_cy import FAULT_REPORTED, FAULT_TAKEN_BACK
from openacr.plant.schema import LOADLESS, Axis, Contact, TorqueDrive, World
from openacr.plant.step_cy import EDGES_LOST, SIGNALS_LOST


class MachineFault(StrEnum):
    """The kinds of faults of an axis of the machine."""

    ENCODER_LOST = "encoder-lost"
    ENCODER_NOISE = "encoder-noise"
    DRIVE = "drive"
    MOTOR_CABLE = "motor-cable"
    JAM = "jam"
    OBSTACLE = "obstacle"
    FRICTION = "friction"
    SUPPLY = "supply"


# The meaning of a fault's value; the other faults have no value.
QUANTITIES = {
    MachineFault.OBSTACLE: "at",
    MachineFault.FRICTION: "torque_nm",
    MachineFault.SUPPLY: "volts",
}


@dataclass(frozen=True, slots=True)
class _Place:
    """An axis of the world and the first indices of its rows."""

    memory: Memory
    axis: Axis
    reals: int
    ints: int

    @property
    def position_cnt(self) -> float:
        return self.memory.F[self.reals + at.PLF_POSITION_CNT]

    def put(self, row: int, value_cnt: float) -> None:
        self.memory.F[self.reals + row] = value_cnt

    def set(self, row: int, value: int) -> None:
        self.memory.I[self.ints + row] = value


def inject(world: World, memory: Memory, axis: int, kind: MachineFault, value: float) -> None:
    """Cause a fault on an axis; UserError if the axis cannot have it.

    `value` is the position of an obstacle in units of the axis, the torque of friction in Nm at
    the shaft of the motor, or the voltage to which the supply of the drive falls.
    """
    _START[kind](_place(world, memory, axis), value)


def mend(world: World, memory: Memory, axis: int, kind: MachineFault | None = None) -> None:
    """Remove one kind of fault of an axis, or all."""
    place = _place(world, memory, axis)
    for one in MachineFault if kind is None else (kind,):
        _END[one](place)


def _place(world: World, memory: Memory, number: int) -> _Place:
    for axis in world.axis:
        if axis.number == number:
            rows = at.PLF_BASE + number * at.PLF_STRIDE, at.PLI_BASE + number * at.PLI_STRIDE
            return _Place(memory, axis, *rows)
    known = ", ".join(str(axis.number) for axis in world.axis) or "none"
    raise UserError(f"axis {number}: the machine has no such axis (it has {known})")


def _lose_signals(place: _Place, _: float) -> None:
    _needs_encoder(place)
    place.memory.I[place.ints + at.PLI_ENCODER_FAULT] |= SIGNALS_LOST


def _disturb_signals(place: _Place, _: float) -> None:
    _needs_encoder(place)
    place.memory.I[place.ints + at.PLI_ENCODER_FAULT] |= EDGES_LOST


def _needs_encoder(place: _Place) -> None:
    if not place.axis.has_encoder:
        raise UserError(f"axis {place.axis.label}: it has no encoder")


def _repair(bit: int) -> Callable[[_Place], None]:
    def end(place: _Place) -> None:
        place.memory.I[place.ints + at.PLI_ENCODER_FAULT] &= ~bit

    return end


def _report_drive(place: _Place, _: float) -> None:
    drive = place.axis.drive
    place.set(at.PLI_FAULT_REPORT, FAULT_REPORTED)
    if drive.fault_input is not None:
        inputs.switch(place.memory, drive.fault_input, drive.fault_contact is Contact.OPEN)


def _end_drive(place: _Place) -> None:
    drive = place.axis.drive
    if place.memory.I[place.ints + at.PLI_FAULT_REPORT] != FAULT_REPORTED:
        return
    place.set(at.PLI_FAULT_REPORT, FAULT_TAKEN_BACK)
    if drive.fault_input is None:
        return
    if inputs.is_driven(place.memory, drive.fault_input):
        inputs.release(place.memory, drive.fault_input)
    else:
        inputs.switch(place.memory, drive.fault_input, drive.fault_contact is Contact.CLOSED)


def _cut_cable(place: _Place, _: float) -> None:
    place.set(at.PLI_CABLE_CUT, 1)


def _join_cable(place: _Place) -> None:
    place.set(at.PLI_CABLE_CUT, 0)


def _jam(place: _Place, _: float) -> None:
    for row in (at.PLF_LOW_STOP_CNT, at.PLF_HIGH_STOP_CNT):
        place.put(row, place.position_cnt)


def _block(place: _Place, at_u: float) -> None:
    """Put an obstacle into the travel, on the side of the load on which it is."""
    border = count_of(place.axis, at_u)
    is_above = border >= place.position_cnt
    place.put(at.PLF_HIGH_STOP_CNT if is_above else at.PLF_LOW_STOP_CNT, border)


def _free(place: _Place) -> None:
    for row, stop in apply.stop_rows(place.axis).items():
        place.put(row, stop)


def _rub(place: _Place, torque_nm: float) -> None:
    if isinstance(place.axis.drive, LOADLESS):
        hint = "its drive moves whatever the load; give it another mode and a motor"
        raise UserError(f"axis {place.axis.label}: friction has no effect ({hint})")
    if torque_nm < 0.0:
        raise UserError(f"axis {place.axis.label}: friction of {torque_nm:g} Nm; it is 0 or more")
    _smooth(place)
    for row in (at.PLF_COULOMB_ACCEL, at.PLF_STATIC_ACCEL):
        own = place.memory.F[place.reals + row]
        place.put(row, own + torque_nm * apply.accel_per_nm(place.axis))


def _smooth(place: _Place) -> None:
    for row, accel in apply.load_rows(place.axis).items():
        place.put(row, accel)


def _dip(place: _Place, volts: float) -> None:
    full_v = _supply_v(place.axis)
    if full_v is None:
        hint = "its drive needs supply_v, its motor resistance_ohm"
        raise UserError(f"axis {place.axis.label}: a supply that falls has no effect ({hint})")
    if not 0.0 < volts <= full_v:
        hint = "without any voltage the fault is `motor-cable`"
        raise UserError(
            f"axis {place.axis.label}: a supply of {volts:g} V; above 0 to {full_v:g} V ({hint})"
        )
    _supply(place, volts)


def _recover(place: _Place) -> None:
    full_v = _supply_v(place.axis)
    if full_v is not None:
        _supply(place, full_v)


def _supply(place: _Place, volts: float) -> None:
    for row, accel in apply.supply_rows(place.axis, volts).items():
        place.put(row, accel)


def _supply_v(axis: Axis) -> float | None:
    """The voltage of the supply, None where nothing depends on it."""
    has_resistance = axis.motor is not None and axis.motor.resistance_ohm is not None
    return axis.drive.supply_v if isinstance(axis.drive, TorqueDrive) and has_resistance else None


_START: dict[MachineFault, Callable[[_Place, float], None]] = {
    MachineFault.ENCODER_LOST: _lose_signals,
    MachineFault.ENCODER_NOISE: _disturb_signals,
    MachineFault.DRIVE: _report_drive,
    MachineFault.MOTOR_CABLE: _cut_cable,
    MachineFault.JAM: _jam,
    MachineFault.OBSTACLE: _block,
    MachineFault.FRICTION: _rub,
    MachineFault.SUPPLY: _dip,
}
_END: dict[MachineFault, Callable[[_Place], None]] = {
    MachineFault.ENCODER_LOST: _repair(SIGNALS_LOST),
    MachineFault.ENCODER_NOISE: _repair(EDGES_LOST),
    MachineFault.DRIVE: _end_drive,
    MachineFault.MOTOR_CABLE: _join_cable,
    MachineFault.JAM: _free,
    MachineFault.OBSTACLE: _free,
    MachineFault.FRICTION: _smooth,
    MachineFault.SUPPLY: _recover,
}
