"""Faults of the machine around the card, injected and removed while it runs.

All state is in the rows of the machine, so that snapshots, restarts of the card and replayed
journals include it. When a fault ends, the changed rows are rewritten from the machine file.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

from openacr.errors import UserError
from openacr.map.memory import Memory
from openacr.map.rows import motors
from openacr.plant import inputs
from openacr.plant.build import apply
from openacr.plant.describe.counts import count_of, position_of
from openacr.plant.describe.schema import LOADLESS, Axis, Contact, TorqueDrive, World
from openacr.plant.physics.drive_cy import FAULT_REPORTED, FAULT_TAKEN_BACK
from openacr.plant.physics.step_cy import EDGES_LOST, SIGNALS_LOST
from openacr.plant.world.fault_kinds import PLACE, TORQUE, VOLTS, MachineFault, Quantity


@dataclass(frozen=True, slots=True)
class _Place:
    """An axis of the world, and its rows."""

    memory: Memory
    axis: Axis

    @property
    def position_cnt(self) -> float:
        return self.memory.F[motors.position_cnt[self.axis.number]]

    def get(self, row: tuple[int, ...]) -> float:
        return self.memory.F[row[self.axis.number]]

    def put(self, row: tuple[int, ...], value_cnt: float) -> None:
        self.memory.F[row[self.axis.number]] = value_cnt

    def set(self, row: tuple[int, ...], value: int) -> None:
        self.memory.I[row[self.axis.number]] = value


def inject(world: World, memory: Memory, axis: int, kind: MachineFault, value: float) -> None:
    """Cause a fault on an axis; UserError if the axis cannot have it, or not with this value.

    `value` is the quantity of the fault, in its unit (see FAULTS).
    """
    place, fault = _place(world, memory, axis), FAULTS[kind]
    if why := fault.bar(place.axis):
        raise UserError(f"axis {place.axis.label}: {why}")
    if fault.quantity is not None:
        fault.quantity.check(place.axis, value, fault.highest(place.axis))
    fault.start(place, value)


def mend(world: World, memory: Memory, axis: int, kind: MachineFault | None = None) -> None:
    """Remove one kind of fault of an axis, or all."""
    place = _place(world, memory, axis)
    for one in MachineFault if kind is None else (kind,):
        FAULTS[one].end(place)


def active(world: World, memory: Memory) -> Iterator[tuple[int, MachineFault, float]]:
    """The faults there are now: number of the axis, kind, value (0 where it has none)."""
    for axis in world.axis:
        place = _place(world, memory, axis.number)
        for kind, fault in FAULTS.items():
            if not fault.bar(axis) and (value := fault.value(place)) is not None:
                yield axis.number, kind, value


def _place(world: World, memory: Memory, number: int) -> _Place:
    for axis in world.axis:
        if axis.number == number:
            return _Place(memory, axis)
    known = ", ".join(str(axis.number) for axis in world.axis) or "none"
    raise UserError(f"axis {number}: the machine has no such axis (it has {known})")


def _lose_signals(place: _Place, _: float) -> None:
    place.memory.I[motors.encoder_fault[place.axis.number]] |= SIGNALS_LOST


def _disturb_signals(place: _Place, _: float) -> None:
    place.memory.I[motors.encoder_fault[place.axis.number]] |= EDGES_LOST


def _needs_encoder(axis: Axis) -> str:
    return "" if axis.has_encoder else "it has no encoder"


def _is_set(row: tuple[int, ...], bits: int) -> Callable[[_Place], float | None]:
    """Whether a fault is there that has bits of a row, or a row, for itself."""

    def value(place: _Place) -> float | None:
        return 0.0 if place.memory.I[row[place.axis.number]] & bits else None

    return value


def _repair(bit: int) -> Callable[[_Place], None]:
    def end(place: _Place) -> None:
        place.memory.I[motors.encoder_fault[place.axis.number]] &= ~bit

    return end


def _report_drive(place: _Place, _: float) -> None:
    drive = place.axis.drive
    place.set(motors.fault_report, FAULT_REPORTED)
    if drive.fault_input is not None:
        inputs.switch(place.memory, drive.fault_input, drive.fault_contact is Contact.OPEN)


def _end_drive(place: _Place) -> None:
    drive = place.axis.drive
    if place.memory.I[motors.fault_report[place.axis.number]] != FAULT_REPORTED:
        return
    place.set(motors.fault_report, FAULT_TAKEN_BACK)
    if drive.fault_input is None:
        return
    if inputs.is_driven(place.memory, drive.fault_input):
        inputs.release(place.memory, drive.fault_input)
    else:
        inputs.switch(place.memory, drive.fault_input, drive.fault_contact is Contact.CLOSED)


def _cut_cable(place: _Place, _: float) -> None:
    place.set(motors.cable_cut, 1)


def _join_cable(place: _Place) -> None:
    place.set(motors.cable_cut, 0)


def _jam(place: _Place, _: float) -> None:
    for row in (motors.low_stop_cnt, motors.high_stop_cnt):
        place.put(row, place.position_cnt)


def _block(place: _Place, at_u: float) -> None:
    """Put an obstacle into the travel, on the side of the load on which it is."""
    border = count_of(place.axis, at_u)
    is_above = border >= place.position_cnt
    place.put(motors.high_stop_cnt if is_above else motors.low_stop_cnt, border)


def _free(place: _Place) -> None:
    for row, stop in apply.stop_rows(place.axis).items():
        place.put(row, stop)


def _is_jammed(place: _Place) -> float | None:
    low, high = place.get(motors.low_stop_cnt), place.get(motors.high_stop_cnt)
    return 0.0 if low == high else None


def _obstacle(place: _Place) -> float | None:
    """Where an obstacle is; None without one."""
    if _is_jammed(place) is not None:
        return None
    stops = apply.stop_rows(place.axis)
    return next(
        (
            _tidy(position_of(place.axis, place.get(row)))
            for row, stop in stops.items()
            if place.get(row) != stop
        ),
        None,
    )


def _needs_load(axis: Axis) -> str:
    hint = "its drive moves whatever the load; give it another mode and a motor"
    return f"friction has no effect ({hint})" if isinstance(axis.drive, LOADLESS) else ""


def _rub(place: _Place, torque_nm: float) -> None:
    _smooth(place)
    for row in (motors.coulomb_accel, motors.static_accel):
        own = place.get(row)
        place.put(row, own + torque_nm * apply.accel_per_nm(place.axis))


def _smooth(place: _Place) -> None:
    for row, accel in apply.load_rows(place.axis).items():
        place.put(row, accel)


def _friction(place: _Place) -> float | None:
    """The additional friction [Nm]; None without any."""
    own = apply.load_rows(place.axis)[motors.coulomb_accel]
    more = place.get(motors.coulomb_accel) - own
    return _tidy(more / apply.accel_per_nm(place.axis)) if more else None


def _needs_supply(axis: Axis) -> str:
    hint = "its drive needs supply_v, its motor resistance_ohm"
    return "" if _supply_v(axis) else f"a supply that falls has no effect ({hint})"


def _recover(place: _Place) -> None:
    full_v = _supply_v(place.axis)
    if full_v is not None:
        _supply(place, full_v)


def _left_v(place: _Place) -> float | None:
    """The voltage to which the supply has fallen; None while it is full."""
    full_v = _supply_v(place.axis) or 0.0
    (row, full) = next(iter(apply.supply_rows(place.axis, full_v).items()))
    now = place.get(row)
    return None if now == full else _tidy(now / full * full_v)


def _tidy(value: float) -> float:
    """A value without the last digits, which the conversion to a row and back changes."""
    return float(f"{value:.9g}")


def _supply(place: _Place, volts: float) -> None:
    for row, accel in apply.supply_rows(place.axis, volts).items():
        place.put(row, accel)


def _supply_v(axis: Axis) -> float | None:
    """The voltage of the supply, None where nothing depends on it."""
    has_resistance = axis.motor is not None and axis.motor.resistance_ohm is not None
    return axis.drive.supply_v if isinstance(axis.drive, TorqueDrive) and has_resistance else None


def _no_bar(_axis: Axis) -> str:
    return ""


def _no_limit(_axis: Axis) -> float | None:
    return None


@dataclass(frozen=True, slots=True)
class Fault:
    """One kind of fault: what begins and ends it, where it is possible, its quantity."""

    start: Callable[[_Place, float], None]
    end: Callable[[_Place], None]
    value: Callable[[_Place], float | None]  # None: it is not there
    bar: Callable[[Axis], str] = _no_bar  # why an axis cannot have it; "" where it can
    quantity: Quantity | None = None
    highest: Callable[[Axis], float | None] = _no_limit  # of the quantity


_LOST = _is_set(motors.encoder_fault, SIGNALS_LOST)
_NOISE = _is_set(motors.encoder_fault, EDGES_LOST)
_REPORTED = _is_set(motors.fault_report, FAULT_REPORTED)
_CUT = _is_set(motors.cable_cut, 1)
# Every kind of fault; scenarios, callers and screens have theirs from here.
FAULTS: Mapping[MachineFault, Fault] = {
    MachineFault.ENCODER_LOST: Fault(_lose_signals, _repair(SIGNALS_LOST), _LOST, _needs_encoder),
    MachineFault.ENCODER_NOISE: Fault(
        _disturb_signals, _repair(EDGES_LOST), _NOISE, _needs_encoder
    ),
    MachineFault.DRIVE: Fault(_report_drive, _end_drive, _REPORTED),
    MachineFault.MOTOR_CABLE: Fault(_cut_cable, _join_cable, _CUT),
    MachineFault.JAM: Fault(_jam, _free, _is_jammed),
    MachineFault.OBSTACLE: Fault(_block, _free, _obstacle, quantity=PLACE),
    MachineFault.FRICTION: Fault(_rub, _smooth, _friction, _needs_load, TORQUE),
    MachineFault.SUPPLY: Fault(_supply, _recover, _left_v, _needs_supply, VOLTS, _supply_v),
}
# The key of a fault's quantity; the other faults have none.
QUANTITIES = {kind: each.quantity.key for kind, each in FAULTS.items() if each.quantity}
