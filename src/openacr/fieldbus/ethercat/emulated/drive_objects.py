"""The objects of an emulated drive (CiA 402), and how they are mapped at first."""

import math
from collections.abc import Iterable

from openacr.fieldbus.ethercat.emulated.dictionary import (
    INPUT,
    OUTPUT,
    RO,
    RW,
    Dictionary,
    Entry,
    SdoError,
    Value,
)
from openacr.fieldbus.ethercat.emulated.motor import OVERLOAD, PERMILLE, Motor
from openacr.fieldbus.ethercat.emulated.pdo import gap
from openacr.fieldbus.ethercat.emulated.slave import VENDOR, describe
from openacr.fieldbus.ethercat.wire import sii
from openacr.fieldbus.ethercat.wire.coe import Abort
from openacr.fieldbus.ethercat.wire.data_types import DataType, limits

PRODUCT = 0x0402
NEGATIVE, POSITIVE, HOME = 1, 2, 4  # of 0x60FD
U8, U16, U32 = DataType.UNSIGNED8, DataType.UNSIGNED16, DataType.UNSIGNED32
I8, I16, I32 = DataType.INTEGER8, DataType.INTEGER16, DataType.INTEGER32
RECEIVED = ((0x6040, U16), (0x607A, I32), (0x60FF, I32), (0x6071, I16), (0x60B8, U16), (0x6060, I8))
TRANSMITTED = (
    (0x6041, U16),
    (0x6064, I32),
    (0x606C, I32),
    (0x6077, I16),
    (0x60F4, I32),
    (0x60B9, U16),
    (0x60BA, I32),
    (0x60BB, I32),
    (0x60FD, U32),
    (0x603F, U16),
    (0x6061, I8),
)
# PDOs that can be assigned instead of the first: position, velocity or torque alone.
_ALONE = ((0x1601, 0x607A, I32), (0x1602, 0x60FF, I32), (0x1603, 0x6071, I16))
_FOLLOWING_TIME_MS = 10
_STOP_S = 0.1  # from the highest speed of a first setting


class DriveObjects:
    """The objects that a drive works with, by name."""

    def __init__(self, dictionary: Dictionary, motor: Motor, modes: tuple[int, ...]) -> None:
        self._motor = motor
        counts = motor.axis.counts or 1
        add = dictionary.add

        def variable(
            index: int,
            name: str,
            kind: DataType,
            access: int,
            value: int = 0,
            low: int | None = None,
        ) -> Entry:
            return add(index, Entry(name, kind, access, value, low))  # type: ignore[arg-type]

        self.error = variable(0x603F, "Error code", U16, INPUT)
        self.control = variable(0x6040, "Controlword", U16, OUTPUT)
        self.status = variable(0x6041, "Statusword", U16, INPUT)
        self.quick_option = variable(0x605A, "Quick stop option code", I16, RW, 2)
        self.quick_option.check = _one_of(0, 1, 2, 5, 6)
        self.fault_option = variable(0x605E, "Fault reaction option code", I16, RW, 2)
        self.fault_option.check = _one_of(0, 1, 2)
        self.mode = variable(0x6060, "Modes of operation", I8, OUTPUT)
        self.mode.check = _one_of(0, *modes)
        self.mode_shown = variable(0x6061, "Modes of operation display", I8, INPUT)
        self.position = variable(0x6064, "Position actual value", I32, INPUT)
        self.following_window = variable(0x6065, "Following error window", U32, RW, counts)
        self.following_time = variable(
            0x6066, "Following error time out", U16, RW, _FOLLOWING_TIME_MS
        )
        self.velocity = variable(0x606C, "Velocity actual value", I32, INPUT)
        self.target_torque = variable(0x6071, "Target torque", I16, OUTPUT)
        highest = round(OVERLOAD * PERMILLE)
        self.max_torque = variable(0x6072, "Max torque", U16, OUTPUT, highest)
        variable(0x6075, "Motor rated current", U32, RO, round(1000 * _rated_amps(motor)))
        variable(0x6076, "Motor rated torque", U32, RO, round(1000 * motor.rated_nm))
        self.torque = variable(0x6077, "Torque actual value", I16, INPUT)
        self.target_position = variable(0x607A, "Target position", I32, OUTPUT)
        self.home_offset = variable(0x607C, "Home offset", I32, RW)
        fast = max(1, min(limits(U32)[1], math.ceil(50 * counts / _STOP_S)))
        self.quick_deceleration = variable(0x6085, "Quick stop deceleration", U32, RW, fast, 1)
        self.homing_method = variable(0x6098, "Homing method", I8, RW, 37)
        self.velocity_offset = variable(0x60B1, "Velocity offset", I32, OUTPUT)
        self.torque_offset = variable(0x60B2, "Torque offset", I16, OUTPUT)
        self.probe_function = variable(0x60B8, "Touch probe function", U16, OUTPUT)
        self.probe_status = variable(0x60B9, "Touch probe status", U16, INPUT)
        self.probed = [
            variable(0x60BA + n, f"Touch probe {n // 2 + 1} {edge} edge", I32, INPUT)
            for n, edge in enumerate(("positive", "negative") * 2)
        ]
        self._cycle = [
            Entry("Interpolation time period value", U8, RW, 1, 1),
            Entry("Interpolation time index", I8, RW, -3, -6, 0),
        ]
        dictionary.add_record(0x60C2, "Interpolation time period", self._cycle)
        self.following_error = variable(0x60F4, "Following error actual value", I32, INPUT)
        self.inputs = variable(0x60FD, "Digital inputs", U32, INPUT)
        self.target_velocity = variable(0x60FF, "Target velocity", I32, OUTPUT)
        supported = sum(1 << mode - 1 for mode in modes)
        variable(0x6502, "Supported drive modes", U32, RO, supported)
        self._outputs = [
            (entry, entry.value)
            for one in dictionary.objects.values()
            for entry in one.entries.values()
            if entry.access & OUTPUT & ~RW
        ]

    def reset(self) -> None:
        """What the master wrote is forgotten: mode, control word, targets."""
        for entry, value in self._outputs:
            entry.value = value
        self.mode_shown.value = self.error.value = self.probe_status.value = 0

    @property
    def cycle_s(self) -> float:
        """The interpolation time: how long the master's cycle is without SYNC0."""
        value: float = self._cycle[0].number * 10.0 ** self._cycle[1].number
        return value

    @property
    def torque_limit(self) -> float:
        """The highest torque, in thousandths of the rated torque."""
        return float(self.max_torque.number)

    def show_inputs(self) -> None:
        """The switches of the axis."""
        motor = self._motor
        self.inputs.value = (
            NEGATIVE * motor.is_active("negative_limit")
            | POSITIVE * motor.is_active("positive_limit")
            | HOME * motor.is_active("home")
        )


def _one_of(*values: int) -> "_OneOf":
    return _OneOf(frozenset(values))


class _OneOf:
    """Refuses other values."""

    def __init__(self, values: frozenset[int]) -> None:
        self._values = values

    def __call__(self, value: Value) -> None:
        if value not in self._values:
            raise SdoError(Abort.RANGE)


def _rated_amps(motor: Motor) -> float:
    one = motor.axis.motor
    per_amp = one.torque_nm_per_a if one is not None else None
    return motor.rated_nm / per_amp if per_amp else 0.0


def drive_description(serial: int, alias: int) -> sii.Description:
    """What the EEPROM of a drive says."""
    receive = [_pdo(0x1600, RECEIVED, 2, "Outputs")]
    receive += [
        _pdo(number, ((0x6040, U16), (index, kind)), 0xFF, "") for number, index, kind in _ALONE
    ]
    transmit = (
        _pdo(0x1A00, TRANSMITTED, 3, "Inputs"),
        _pdo(0x1A01, ((0x6041, U16), (0x6064, I32)), 0xFF, ""),
    )
    identity = sii.Identity(VENDOR, PRODUCT, 1, serial)
    return describe(identity, "drive", tuple(receive), transmit, alias)


def _pdo(index: int, mapped: Iterable[tuple[int, DataType]], sync: int, name: str) -> sii.Pdo:
    entries = [sii.Entry(each, 0, kind.bits, f"{each:04X}", kind) for each, kind in mapped]
    if sum(entry.bits for entry in entries) % 16:
        entries.append(gap(8))
    return sii.Pdo(index, tuple(entries), sync, name or f"{index:04X}")
