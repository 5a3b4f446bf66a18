"""The binary move: a bit-mapped header and the data fields it announces (UG2 ch. 6).

    04 code0 code1 code2 [code3 [code4 code5 code6 code7]]
       [VEL] [FVEL] [ACC] [targets of slaves 0-15] [two centers] [two scalings]

Code 3 is there when code 0 has bit 3, codes 4 to 7 when code 3 has bit 7; absent codes
count as zero. What bits 0 to 2 of code 0 mean depends on a flag of the master (Enable
Rapid Move Modes), so a decoded move keeps the codes and `profile()` reads them.
"""

import struct
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from enum import IntEnum, IntFlag
from functools import lru_cache
from typing import ClassVar, Self

from openacr.protocol.packet import WORD_BYTES, Packet, PacketError, Part, pack_word, register

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
# Plain integers are much quicker than flags, and moves come by the thousand.
CODE_3_PRESENT, VEL, ACC = Code0.CODE_3_PRESENT.value, Code0.VEL.value, Code0.ACC.value
ARC, FVEL, SCALING = Code1.ARC.value, Code3.FVEL.value, Code3.SCALING.value
FLOATING_POINT, EXTENDED = Code3.FLOATING_POINT.value, Code3.EXTENDED.value


class Curve(IntEnum):
    """The kind of path of one move."""

    LINE = 0
    ARC = 1
    NURB = 2
    SPLINE = 3


@dataclass(frozen=True, slots=True)
class Profile:
    """What header code 0 says about speed: ramps at the end and which override applies."""

    stop_ramp: bool  # STP := DEC for this move, else STP := 0
    final_velocity_zero: bool  # FVEL 0 for this move
    rapid: bool  # ROV instead of FOV
    override_locked: bool  # the override counts as 1.0


@dataclass(frozen=True, slots=True)
class _Header:
    """What header codes say: which fields follow, and what kind of move it is."""

    length: int
    slaves: tuple[int, ...]
    vel: bool
    fvel: bool
    acc: bool
    centers: bool
    scaling: bool
    floating: bool
    master: int
    curve: Curve
    counter_step: int
    is_relative: bool
    has_relative_center: bool
    is_counterclockwise: bool
    is_block_skip: bool
    interrupts: bool
    fields: struct.Struct  # of the data, in wire order

    @property
    def size(self) -> int:
        """Bytes of the whole packet."""
        return self.length + self.fields.size


@lru_cache(maxsize=1024)
def _header(codes: bytes) -> _Header:
    """What eight header codes say; hosts send few different ones, but thousands a second."""
    code0, code1, code3 = Code0(codes[0]), Code1(codes[1]), Code3(codes[3])
    present = codes[2] | codes[6] << 8
    curve = _curve(code1, code3)
    step = -1 if code0 & Code0.COUNT_DOWN else 1
    slaves = tuple(slave for slave in range(SLAVES) if present >> slave & 1)
    vel, fvel, acc = bool(code0 & Code0.VEL), bool(code3 & Code3.FVEL), bool(code0 & Code0.ACC)
    centers, scaling = curve is Curve.ARC, bool(code3 & Code3.SCALING)
    position = "f" if code3 & Code3.FLOATING_POINT else "i"
    positions = position * (len(slaves) + 2 * centers)
    return _Header(
        length=_header_length(code0, code3),
        slaves=slaves,
        vel=vel,
        fvel=fvel,
        acc=acc,
        centers=centers,
        scaling=scaling,
        floating=bool(code3 & Code3.FLOATING_POINT),
        master=(8 if codes[4] & MASTER_BIT_3 else 0) | int(code1 & Code1.MASTER),
        curve=curve,
        counter_step=step if code0 & Code0.COUNTER else 0,
        is_relative=bool(code3 & Code3.INCREMENTAL_TARGET),
        has_relative_center=bool(code3 & Code3.INCREMENTAL_CENTER),
        is_counterclockwise=bool(code1 & Code1.COUNTERCLOCKWISE),
        is_block_skip=bool(code3 & Code3.BLOCK_SKIP),
        interrupts=bool(code1 & Code1.INTERRUPT),
        fields=struct.Struct("<" + "f" * (vel + fvel + acc) + positions + "ff" * scaling),
    )


def _curve(code1: Code1, code3: Code3) -> Curve:
    if code3 & Code3.CURVE:
        return Curve.NURB if code1 & Code1.NURB else Curve.SPLINE
    return Curve.ARC if code1 & Code1.ARC else Curve.LINE


def _codes(prefix: bytes) -> bytes:
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
def _profile(code0: int, rapid_move_modes: bool) -> Profile:
    low, ramp = bool(code0 & 1), bool(code0 & 4)
    locked = bool(Code0(code0) & Code0.OVERRIDE_LOCKOUT)
    if not rapid_move_modes:
        return Profile(ramp, low, rapid=False, override_locked=locked)
    return Profile(ramp or low, low, rapid=low and ramp, override_locked=locked)


@register
@dataclass(frozen=True, slots=True)
class Move(Packet):
    """One move of a master; the card sends nothing back.

    `targets` holds (slave, value) in rising order: control points for NURBs and splines.
    Values are floats (user units) with FLOATING_POINT, integers (pulses) otherwise.
    """

    HEADER: ClassVar[bytes] = b"\x04"
    codes: bytes
    vel: float | None = None
    fvel: float | None = None
    acc: float | None = None
    targets: tuple[tuple[int, int | float], ...] = ()
    centers: tuple[int | float, int | float] | None = None
    scaling: tuple[float, float] | None = None

    @classmethod
    def of(
        cls,
        targets: Mapping[int, int | float],
        *,
        master: int = 0,
        code0: int = 0,
        code1: int = 0,
        code3: int = 0,
        vel: float | None = None,
        fvel: float | None = None,
        acc: float | None = None,
        centers: tuple[int | float, int | float] | None = None,
        scaling: tuple[float, float] | None = None,
    ) -> Self:
        """A move with the header bits that its fields need added to the given codes.

        Floats anywhere in targets or centers make them all IEEE; the master number and
        the slaves present are entered into the codes.
        """
        positions = [*targets.values(), *(centers or ())]
        code0 |= (VEL if vel is not None else 0) | (ACC if acc is not None else 0)
        code1 |= (master & 7) | (ARC if centers is not None else 0)
        code3 |= (FVEL if fvel is not None else 0) | (SCALING if scaling else 0)
        if float in map(type, positions):
            code3 |= FLOATING_POINT
        present = sum(1 << slave for slave in targets)
        if present >> SLAVES or not 0 <= master < 16:
            raise PacketError(f"slaves {sorted(targets)} of master {master}: both are 0..15")
        if master > 7 or present > 0xFF:
            code3 |= EXTENDED
        if code3:
            code0 |= CODE_3_PRESENT
        code4 = MASTER_BIT_3 if master > 7 else 0
        codes = bytes((code0, code1, present & 0xFF, code3, code4, 0, present >> 8, 0))
        return cls(codes, vel, fvel, acc, tuple(sorted(targets.items())), centers, scaling)

    @classmethod
    def total_length(cls, prefix: bytes) -> int:
        """Header as far as it is known, then one word per announced field."""
        header = _header(_codes(prefix))
        if len(prefix) < header.length:
            return header.length
        return header.size

    @classmethod
    def decode(cls, data: bytes) -> Self:
        """The move in exactly these bytes."""
        codes = _codes(data)
        header = _header(codes)
        if len(data) != header.size:
            raise PacketError(f"Move: {len(data)} bytes do not fit the header codes")
        values = iter(header.fields.unpack_from(data, header.length))
        vel = next(values) if header.vel else None
        fvel = next(values) if header.fvel else None
        acc = next(values) if header.acc else None
        targets = tuple((slave, next(values)) for slave in header.slaves)
        centers = (next(values), next(values)) if header.centers else None
        scaling = (next(values), next(values)) if header.scaling else None
        return cls(codes, vel, fvel, acc, targets, centers, scaling)

    def encode(self) -> bytes:
        """Header as long as the codes announce, then the fields."""
        head = self.HEADER + self.codes
        header = _header(self.codes)
        data = b"".join([pack_word(value) for value in self.values()])
        if len(data) != header.fields.size:
            raise PacketError("Move: the fields are not those that the header codes announce")
        return head[: header.length] + data

    def values(self) -> Iterator[int | float]:
        """The data fields in wire order and wire type."""
        header = _header(self.codes)
        kind = float if header.floating else int
        for value in (self.vel, self.fvel, self.acc):
            if value is not None:
                yield float(value)
        for _, target in self.targets:
            yield kind(target)
        for center in self.centers or ():
            yield kind(center)
        for scale in self.scaling or ():
            yield float(scale)

    def names(self) -> list[str]:
        """What the data fields are, in wire order."""
        profile = (("VEL", self.vel), ("FVEL", self.fvel), ("ACC", self.acc))
        names = [name for name, value in profile if value is not None]
        names += [f"slave {slave}" for slave, _ in self.targets]
        for what, pair in (("center", self.centers), ("scaling", self.scaling)):
            names += [f"primary {what}", f"secondary {what}"] if pair else []
        return names

    @property
    def code0(self) -> Code0:
        """Profile, presence and counter bits."""
        return Code0(self.codes[0])

    @property
    def code1(self) -> Code1:
        """Master, interrupt and arc bits."""
        return Code1(self.codes[1])

    @property
    def code3(self) -> Code3:
        """Data format bits; zero when the packet has no header code 3."""
        return Code3(self.codes[3])

    @property
    def master(self) -> int:
        """The master this move is for, 0 to 15."""
        return _header(self.codes).master

    @property
    def curve(self) -> Curve:
        """Line, arc, NURB or spline."""
        return _header(self.codes).curve

    @property
    def arc_slaves(self) -> tuple[int, int]:
        """Primary and secondary slave of the arc plane; plane 3 is reserved."""
        plane = self.codes[1] >> 6
        if plane == 3:
            raise PacketError("arc plane 3 is reserved")
        return plane, (plane + 1) % 3

    @property
    def counter_step(self) -> int:
        """What this move adds to the master move counter: 0, 1 or -1."""
        return _header(self.codes).counter_step

    @property
    def is_relative(self) -> bool:
        """Targets count from the end of the move before."""
        return _header(self.codes).is_relative

    @property
    def has_relative_center(self) -> bool:
        """Centers count from the beginning of the arc."""
        return _header(self.codes).has_relative_center

    @property
    def is_counterclockwise(self) -> bool:
        """The sense of an arc."""
        return _header(self.codes).is_counterclockwise

    @property
    def is_block_skip(self) -> bool:
        """The move is left out while block skip is on."""
        return _header(self.codes).is_block_skip

    @property
    def interrupts(self) -> bool:
        """The card interrupts the PC at this move."""
        return _header(self.codes).interrupts

    def profile(self, rapid_move_modes: bool) -> Profile:
        """Ramps and override, with Enable Rapid Move Modes of the master set or clear."""
        return _profile(self.codes[0], rapid_move_modes)

    def explain(self) -> list[Part]:
        """Header codes and data fields, one line each."""
        data = self.encode()
        start = _header(self.codes).length
        parts = [Part(data[:1], "header", "Move")]
        parts += [
            Part(data[at : at + 1], f"header code {at - 1}", _code_text(at - 1, data[at]))
            for at in range(1, start)
        ]
        for n, (name, value) in enumerate(zip(self.names(), self.values(), strict=True)):
            at = start + WORD_BYTES * n
            parts.append(Part(data[at : at + WORD_BYTES], name, value))
        return parts


def _code_text(number: int, value: int) -> str:
    kinds: dict[int, type[IntFlag]] = {0: Code0, 1: Code1, 3: Code3}
    kind = kinds.get(number)
    return f"0x{value:02X}" if kind is None else str(kind(value).name or f"0x{value:02X}")


def unpadded(segment: bytes) -> bytes | None:
    """The documented form of a move whose five header bytes were zero-padded to eight.

    One host sends that form. It is told apart by length: the segment holds exactly this
    one packet, three bytes longer than its header announces, and those three are zero.
    """
    if len(segment) < PADDED_HEADER or segment[5:PADDED_HEADER] != bytes(3):
        return None
    header = _header(_codes(segment))
    if header.length != MIDDLE_HEADER:
        return None
    if len(segment) != PADDED_HEADER + header.fields.size:
        return None
    return segment[:MIDDLE_HEADER] + segment[PADDED_HEADER:]
