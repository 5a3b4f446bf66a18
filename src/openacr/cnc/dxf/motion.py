"""Chains as a program of coordinated moves for the card, in AcroBASIC.

The speed is kept from one piece into the next where the path has no corner (STP 0: no ramp at the
end of a move); at corners and ends it is 0. The rates of the ramps have to be known for that.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from openacr.cnc.dxf.chains import Chain
from openacr.cnc.dxf.segments import Segment
from openacr.cnc.dxf.writing import Numbers, described, written

SMOOTH = math.cos(math.radians(1.0))  # of the angle between two pieces without a corner
IN_MOTION, FLAGS_PER_MASTER = 516, 32


@dataclass(frozen=True, slots=True)
class MotionMachine:
    """What runs the program; lengths in the unit of the drawing, by seconds.

    Without a number the profile of the set-up holds: VEL, or ACC, DEC and STP. Without `levels`
    nothing goes up and down; `output` is on while a path is cut.
    """

    program: int = 0  # its number, that of its master as well
    axes: tuple[str, ...] = ("X", "Y", "Z")
    feed: float | None = None
    rapid: float | None = None
    ramp: float | None = None
    levels: tuple[float, float] | None = None  # Z between the chains and while cutting
    output: int | None = None


def motion_program(
    chains: Sequence[Chain],
    numbers: Numbers,
    machine: MotionMachine,
    *,
    title: str,
    straight: float,
) -> str:
    """The chains one after the other; arcs flatter than `straight` become lines."""
    writer = _Writer(numbers, machine)
    lines = ["PROGRAM", f"REM {title}", *writer.head()]
    for number, chain in enumerate(chains, 1):
        lines.append(f"REM chain {number}: {described(chain, numbers)}")
        lines += writer.chain(list(written(chain, numbers, straight)))
    return "\n".join([*lines, *writer.rest(), "ENDP", ""])


class _Writer:
    """Writes the statements of one program."""

    def __init__(self, numbers: Numbers, machine: MotionMachine) -> None:
        self._numbers, self._machine = numbers, machine
        self._wait = f"INH -{IN_MOTION + FLAGS_PER_MASTER * machine.program}"

    def head(self) -> Iterator[str]:
        """The ramps, and the tool up."""
        if self._machine.ramp is not None:
            ramp = self._numbers.text(self._machine.ramp)
            yield f"ACC {ramp} DEC {ramp} STP {ramp}"
        yield from self._speed(self._machine.rapid)
        yield from self._level(0)

    def rest(self) -> Iterator[str]:
        """The program ends when the path does."""
        yield self._wait

    def chain(self, pieces: list[Segment]) -> Iterator[str]:
        """To the begin of a chain, around, and up again."""
        if not pieces:
            return
        yield from self._speed(self._machine.rapid)
        yield self._targets(pieces[0].start)
        yield from self._speed(self._machine.feed)
        yield from self._level(1)
        yield from self._switch("SET")
        is_smooth = False
        for piece, following in zip(pieces, [*pieces[1:], None], strict=True):
            was_smooth, is_smooth = is_smooth, following is not None and _joins(piece, following)
            if is_smooth is not was_smooth:
                yield from self._end_ramp(is_smooth)
            yield self._piece(piece)
        yield from self._switch("CLR")
        yield from self._level(0)

    def _end_ramp(self, is_smooth: bool) -> Iterator[str]:
        if self._machine.ramp is not None:
            yield f"STP {0 if is_smooth else self._numbers.text(self._machine.ramp)}"

    def _speed(self, speed: float | None) -> Iterator[str]:
        if speed is not None:
            yield f"VEL {self._numbers.text(speed)}"

    def _level(self, number: int) -> Iterator[str]:
        if self._machine.levels is not None:
            level = self._numbers.text(self._machine.levels[number])
            yield f"{self._machine.axes[2]}{level}"

    def _switch(self, word: str) -> Iterator[str]:
        if self._machine.output is not None:
            yield self._wait
            yield f"{word} {self._machine.output}"

    def _targets(self, point: tuple[float, float]) -> str:
        named = zip(self._machine.axes, point, strict=False)
        return " ".join(f"{axis}{self._numbers.text(value)}" for axis, value in named)

    def _piece(self, piece: Segment) -> str:
        if piece.centre is None:
            return self._targets(piece.end)
        word = "CIRCCW" if piece.sweep_rad > 0 else "CIRCW"
        text = self._numbers.text
        places = zip(self._machine.axes, piece.end, piece.centre, strict=False)
        return " ".join([word, *(f"{axis}({text(end)},{text(c)})" for axis, end, c in places)])


def _joins(piece: Segment, following: Segment) -> bool:
    """Whether two pieces meet without a corner."""
    (x, y), (u, v) = piece.tangent(piece.end), following.tangent(following.start)
    return x * u + y * v >= SMOOTH
