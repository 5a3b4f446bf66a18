"""The binary move: a bit-mapped header and the data fields it announces (UG2 ch. 6).

    04 code0 code1 code2 [code3 [code4 code5 code6 code7]]
       [VEL] [FVEL] [ACC] [targets of slaves 0-15] [two centers] [two scalings] [path tolerance]

Code 3 is there when code 0 has bit 3, codes 4 to 7 when code 3 has bit 7; absent codes
count as zero. What bits 0 to 2 of code 0 mean depends on a flag of the master (Enable
Rapid Move Modes), so a decoded move keeps the codes and `profile()` reads them.

The path tolerance is an extension: bit 0 of header code 5 announces it, which the manual
leaves reserved. Only openacr cards accept it.
"""

import struct
from collections.abc import Iterator, Mapping
from typing import ClassVar, Self

from openacr.protocol.bits import ClearBit, SetBit
from openacr.protocol.host import Host, PacketError, finite
from openacr.protocol.move_codes import (
    ACC,
    ARC,
    CODE_3_PRESENT,
    EXTENDED,
    FLOATING_POINT,
    FVEL,
    MASTER_BIT_3,
    MIDDLE_HEADER,
    PADDED_HEADER,
    SCALING,
    SLAVES,
    TOLERANCE,
    VEL,
    Code0,
    Code1,
    Code3,
    Header,
    Profile,
    all_codes,
    code_text,
    header_of,
    profile_of,
)
from openacr.protocol.packet import WORD_BYTES, Packet, Part, pack_word, register

FLAG_BYTES = 3  # of a SET or CLR packet
NO_TARGET = 1e-9  # no real target is as small as this


@register
class Move(Packet, frozen=True):
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
    tolerance: float | None = None  # an extension

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
        tolerance: float | None = None,
    ) -> Self:
        """Build a move, adding the header bits that its fields need to the given codes.

        A float anywhere in targets or centers makes them all IEEE; the master number and
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
        if master > 7 or present > 0xFF or tolerance is not None:
            code3 |= EXTENDED
        if code3:
            code0 |= CODE_3_PRESENT
        code4 = MASTER_BIT_3 if master > 7 else 0
        code5 = TOLERANCE if tolerance is not None else 0
        codes = bytes((code0, code1, present & 0xFF, code3, code4, code5, present >> 8, 0))
        goals = tuple(sorted(targets.items()))
        return cls(codes, vel, fvel, acc, goals, centers, scaling, tolerance)

    @classmethod
    def total_length(cls, prefix: bytes) -> int:
        """Header as far as it is known, then one word per announced field."""
        header = header_of(all_codes(prefix))
        if len(prefix) < header.length:
            return header.length
        return header.size

    @classmethod
    def decode(cls, data: bytes) -> Self:
        """The move in exactly these bytes."""
        codes = all_codes(data)
        header = header_of(codes)
        if len(data) != header.size:
            raise PacketError(f"Move: {len(data)} bytes do not fit the header codes")
        values = iter(header.fields.unpack_from(data, header.length))
        vel = next(values) if header.vel else None
        fvel = next(values) if header.fvel else None
        acc = next(values) if header.acc else None
        targets = tuple((slave, next(values)) for slave in header.slaves)
        centers = (next(values), next(values)) if header.centers else None
        scaling = (next(values), next(values)) if header.scaling else None
        tolerance = next(values) if header.tolerance else None
        return cls(codes, vel, fvel, acc, targets, centers, scaling, tolerance)

    def encode(self) -> bytes:
        """Header as long as the codes announce, then the fields."""
        head = self.HEADER + self.codes
        header = self.header
        data = b"".join([pack_word(value) for value in self.values()])
        if len(data) != header.fields.size:
            raise PacketError("Move: the fields are not those that the header codes announce")
        return head[: header.length] + data

    def act(self, host: Host) -> bytes:
        """Queue the move, unless a value is not a number."""
        for value in self.values():
            finite(value)
        host.issue_move(self)
        return b""

    def values(self) -> Iterator[int | float]:
        """The data fields in wire order and wire type."""
        header = self.header
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
        if self.tolerance is not None:
            yield self.tolerance

    def names(self) -> list[str]:
        """The names of the data fields, in wire order."""
        profile = (("VEL", self.vel), ("FVEL", self.fvel), ("ACC", self.acc))
        names = [name for name, value in profile if value is not None]
        names += [f"slave {slave}" for slave, _ in self.targets]
        for what, pair in (("center", self.centers), ("scaling", self.scaling)):
            names += [f"primary {what}", f"secondary {what}"] if pair else []
        return names + ["path tolerance"] * (self.tolerance is not None)

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
    def header(self) -> Header:
        """What the header codes say of the move."""
        return header_of(self.codes)

    @property
    def master(self) -> int:
        """The master this move is for, 0 to 15."""
        return self.header.master

    @property
    def arc_slaves(self) -> tuple[int, int]:
        """Primary and secondary slave of the arc plane; plane 3 is reserved."""
        plane = self.codes[1] >> 6
        if plane == 3:
            raise PacketError("arc plane 3 is reserved")
        return plane, (plane + 1) % 3

    def profile(self, rapid_move_modes: bool) -> Profile:
        """Ramps and override, with Enable Rapid Move Modes of the master set or clear."""
        return profile_of(self.codes[0], rapid_move_modes)

    def explain(self) -> list[Part]:
        """Header codes and data fields, one line each."""
        data = self.encode()
        start = self.header.length
        parts = [Part(data[:1], "header", "Move")]
        parts += [
            Part(data[at : at + 1], f"header code {at - 1}", code_text(at - 1, data[at]))
            for at in range(1, start)
        ]
        for n, (name, value) in enumerate(zip(self.names(), self.values(), strict=True)):
            at = start + WORD_BYTES * n
            parts.append(Part(data[at : at + WORD_BYTES], name, value))
        return parts


def unpadded(segment: bytes) -> bytes | None:
    """The documented form of a move whose five header bytes were zero-padded to eight.

    One host sends that form. It is recognized by its length: the segment holds exactly this
    one packet, three bytes longer than its header announces, and those three are zero.
    A SET or CLR packet after the documented form gives the same length; read as the end of
    a float, its flag number would be an exponent that makes the value practically zero.
    """
    if len(segment) < PADDED_HEADER or segment[5:PADDED_HEADER] != bytes(3):
        return None
    header = header_of(all_codes(segment))
    if header.length != MIDDLE_HEADER:
        return None
    if len(segment) != PADDED_HEADER + header.fields.size:
        return None
    if header.floating and segment[-FLAG_BYTES:][:1] in (SetBit.HEADER, ClearBit.HEADER):
        (last,) = struct.unpack("<f", segment[-WORD_BYTES:])
        if abs(last) < NO_TARGET:
            return None
    return segment[:MIDDLE_HEADER] + segment[PADDED_HEADER:]
