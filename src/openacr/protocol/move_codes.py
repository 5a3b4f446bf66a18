"""The header codes of a binary move: which fields follow, and what kind of move it is."""

import struct
from enum import IntEnum, IntFlag
from functools import lru_cache

from msgspec import Struct

SLAVES = 16
SHORT_HEADER, MIDDLE_HEADER, LONG_HEADER = 4, 5, 9
PADDED_HEADER = 8


class Code0(IntFlag):
    """Header code 0; bits 0 to 2 have two definitions (`profile`)."""

    FVEL_LOCKOUT = MOVE_MODE_BIT_1 = 0x01
    OVERRIDE_LOCKOUT = 0x02
    STP_RAMP = MOVE_MODE_BIT_0 = 0x04
    CODE_3_PRESENT = 0x08
    VEL = 0x10
    ACC = 0x20
    COUNT_DOWN = 0x40
    COUNTER = 0x80


class Code1(IntFlag):
    """Header code 1; bits 5 to 7 are read differently for NURBs and splines."""

    MASTER = 0x07
    INTERRUPT = 0x08
    COUNTERCLOCKWISE = 0x10
    ARC = SPLINE_KNOTS = 0x20
    PLANE_BIT_0 = NURB = 0x40
    PLANE_BIT_1 = SPLINE = 0x80


class Code3(IntFlag):
    """Header code 3."""

    INCREMENTAL_TARGET = 0x01
    INCREMENTAL_CENTER = 0x02
    FLOATING_POINT = 0x04
    SCALING = 0x08
    FVEL = 0x10
    BLOCK_SKIP = 0x20
    CURVE = 0x40
    EXTENDED = 0x80


MASTER_BIT_3 = 0x08  # of header code 4
TOLERANCE = 0x01  # of header code 5, reserved on real cards: the packet ends with a path tolerance
# Plain integers are much faster than flags, and moves arrive by the thousand.
CODE_3_PRESENT, VEL, ACC = Code0.CODE_3_PRESENT.value, Code0.VEL.value, Code0.ACC.value
ARC, FVEL, SCALING = Code1.ARC.value, Code3.FVEL.value, Code3.SCALING.value
FLOATING_POINT, EXTENDED = Code3.FLOATING_POINT.value, Code3.EXTENDED.value


class Curve(IntEnum):
    """The kind of path of one move."""

    LINE = 0
    ARC = 1
    NURB = 2
    SPLINE = 3


class Profile(Struct, frozen=True):
    """The speed settings of header code 0: ramps at the end, and the override that applies."""

    stop_ramp: bool  # STP := DEC for this move, else STP := 0
    final_velocity_zero: bool  # FVEL 0 for this move
    rapid: bool  # ROV instead of FOV
    override_locked: bool  # the override counts as 1.0


class Header(Struct, frozen=True):
    """Decoded header codes: which fields follow, and what kind of move it is."""

    length: int
    slaves: tuple[int, ...]
    vel: bool
    fvel: bool
    acc: bool
    centers: bool
    scaling: bool
    tolerance: bool
    floating: bool
    master: int
    curve: Curve
    counter_step: int  # what the move adds to the master move counter: 0, 1 or -1
    is_relative: bool  # targets count from the end of the move before
    has_relative_center: bool  # centers count from the beginning of the arc
    is_counterclockwise: bool
    is_block_skip: bool  # the move is left out while block skip is on
    interrupts: bool  # the card interrupts the PC at this move
    fields: struct.Struct  # of the data, in wire order

    @property
    def size(self) -> int:
        """Bytes of the whole packet."""
        return self.length + self.fields.size


@lru_cache(maxsize=1024)
def header_of(codes: bytes) -> Header:
    """Decode eight header codes; cached, since hosts send few different ones very often."""
    code0, code1, code3 = Code0(codes[0]), Code1(codes[1]), Code3(codes[3])
    present = codes[2] | codes[6] << 8
    curve = _curve(code1, code3)
    step = -1 if code0 & Code0.COUNT_DOWN else 1
    slaves = tuple(slave for slave in range(SLAVES) if present >> slave & 1)
    tolerance = bool(codes[5] & TOLERANCE)
    vel, fvel, acc = bool(code0 & Code0.VEL), bool(code3 & Code3.FVEL), bool(code0 & Code0.ACC)
    centers, scaling = curve is Curve.ARC, bool(code3 & Code3.SCALING)
    position = "f" if code3 & Code3.FLOATING_POINT else "i"
    positions = position * (len(slaves) + 2 * centers)
    return Header(
        length=_header_length(code0, code3),
        slaves=slaves,
        vel=vel,
        fvel=fvel,
        acc=acc,
        centers=centers,
        scaling=scaling,
        tolerance=tolerance,
        floating=bool(code3 & Code3.FLOATING_POINT),
        master=(8 if codes[4] & MASTER_BIT_3 else 0) | int(code1 & Code1.MASTER),
        curve=curve,
        counter_step=step if code0 & Code0.COUNTER else 0,
        is_relative=bool(code3 & Code3.INCREMENTAL_TARGET),
        has_relative_center=bool(code3 & Code3.INCREMENTAL_CENTER),
        is_counterclockwise=bool(code1 & Code1.COUNTERCLOCKWISE),
        is_block_skip=bool(code3 & Code3.BLOCK_SKIP),
        interrupts=bool(code1 & Code1.INTERRUPT),
        fields=struct.Struct(
            "<" + "f" * (vel + fvel + acc) + positions + "ff" * scaling + "f" * tolerance
        ),
    )


def _curve(code1: Code1, code3: Code3) -> Curve:
    if code3 & Code3.CURVE:
        return Curve.NURB if code1 & Code1.NURB else Curve.SPLINE
    return Curve.ARC if code1 & Code1.ARC else Curve.LINE


def all_codes(prefix: bytes) -> bytes:
    """The eight header codes at the start of a packet; those not present are zero."""
    codes = prefix[1:LONG_HEADER]
    if len(codes) > 0 and not codes[0] & CODE_3_PRESENT:
        codes = codes[:3]
    elif len(codes) > 3 and not codes[3] & EXTENDED:
        codes = codes[:4]
    return codes.ljust(8, b"\0")


def _header_length(code0: int, code3: int) -> int:
    if not code0 & Code0.CODE_3_PRESENT:
        return SHORT_HEADER
    return LONG_HEADER if code3 & Code3.EXTENDED else MIDDLE_HEADER


@lru_cache(maxsize=512)
def profile_of(code0: int, rapid_move_modes: bool) -> Profile:
    """Decode the low bits of header code 0, with or without rapid move modes."""
    low, ramp = bool(code0 & 1), bool(code0 & 4)
    locked = bool(Code0(code0) & Code0.OVERRIDE_LOCKOUT)
    if not rapid_move_modes:
        return Profile(ramp, low, rapid=False, override_locked=locked)
    return Profile(ramp or low, low, rapid=low and ramp, override_locked=locked)


def code_text(number: int, value: int) -> str:
    """One header code in words."""
    kinds: dict[int, type[IntFlag]] = {0: Code0, 1: Code1, 3: Code3}
    kind = kinds.get(number)
    return f"0x{value:02X}" if kind is None else str(kind(value).name or f"0x{value:02X}")
