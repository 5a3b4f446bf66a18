"""Chains and holes as part programs, to be read by people and machines."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from openacr.cnc.dxf.chains import ORIGIN, Chain, Nearest
from openacr.cnc.dxf.leads import Led, quarter
from openacr.cnc.dxf.segments import Point, Segment

DECIMALS = {False: 6, True: 5}  # inch, millimetres
UNIT_CODES = {False: "G20", True: "G21"}


@dataclass(frozen=True, slots=True)
class Numbers:
    """How numbers are written in one unit."""

    is_metric: bool

    def text(self, value: float) -> str:
        """A number without needless zeros; never `-0`."""
        text = f"{value:.{DECIMALS[self.is_metric]}f}".rstrip("0").rstrip(".")
        return "0" if text == "-0" else text

    def words(self, letters: str, values: Sequence[float]) -> str:
        """Words like `X1 Y2.5`."""
        pairs = zip(letters, values, strict=True)
        return " ".join(f"{letter}{self.text(value)}" for letter, value in pairs)

    def same(self, a: Point, b: Point) -> bool:
        """Whether two points are written alike."""
        return all(self.text(one) == self.text(other) for one, other in zip(a, b, strict=True))


def path_program(
    chains: Sequence[Chain | Led],
    numbers: Numbers,
    *,
    title: str,
    safe_height: float,
    cut_z: float,
    feed: float | None,
    straight: float,
    d_number: int = 0,
) -> str:
    """The chains one after the other, at Z `cut_z`; arcs flatter than `straight` become lines.

    Chains with a lead are compensated by the radius D.
    """
    up, down = (
        f"{code} {numbers.words('Z', [z])}" for code, z in (("G0", safe_height), ("G1", cut_z))
    )
    lines = [*_head(title, numbers), "G200 F2"]
    if feed is not None:
        lines.append(numbers.words("F", [feed]))
    for number, path in enumerate(chains, 1):
        chain = path.chain if isinstance(path, Led) else path
        lines += [f"; chain {number}: {described(chain, numbers)}", up]
        if isinstance(path, Led):
            lines += _compensated(path, numbers, straight, d_number, down)
        else:
            lines += [f"G0 {numbers.words('XY', chain.start)}", down]
            lines += _moves(chain, numbers, straight)
    return "\n".join([*lines, up, "M2", ""])


def _head(title: str, numbers: Numbers) -> list[str]:
    return [f"; {title}", "G90 G17", UNIT_CODES[numbers.is_metric]]


def described(chain: Chain, numbers: Numbers) -> str:
    """A chain in words."""
    if chain.is_closed:
        kind = "closed, " + ("counter-clockwise" if chain.area > 0 else "clockwise")
    else:
        kind = "open"
    return f"{kind}, length {numbers.text(chain.length)}"


def _compensated(
    led: Led, numbers: Numbers, straight: float, d_number: int, down: str
) -> Iterator[str]:
    """Beside the contour, on the lead circle to it, around, and away."""
    chain, contact = led.chain, led.chain.start
    into = quarter(led.first, contact, led.centre, led.is_left)
    out = quarter(contact, led.last, led.centre, led.is_left)
    yield f"G0 {numbers.words('XY', led.centre)}"
    yield down
    yield f"G{41 if led.is_left else 42} D{d_number} G1 {numbers.words('XY', led.first)}"
    yield from _moves(Chain((into, *chain.segments, out), is_closed=False), numbers, straight)
    yield f"G40 G1 {numbers.words('XY', led.centre)}"


def _moves(chain: Chain, numbers: Numbers, straight: float) -> Iterator[str]:
    for segment in written(chain, numbers, straight):
        end = numbers.words("XY", segment.end)
        if segment.centre is None:
            yield f"G1 {end}"
        else:
            code = "G3" if segment.sweep_rad > 0 else "G2"
            yield f"{code} {end} {numbers.words('IJ', segment.centre)}"


def written(chain: Chain, numbers: Numbers, straight: float) -> Iterator[Segment]:
    """The segments of a chain that are written; arcs flatter than `straight` are lines."""
    here = chain.start
    for segment in chain.segments:
        is_full = segment.centre is not None and abs(segment.sweep_rad) > math.pi
        if numbers.same(here, segment.end) and not is_full:
            continue  # an arc that ended where it starts would be a full circle
        is_line = segment.centre is None or (segment.height < straight and not is_full)
        yield Segment(here, segment.end) if is_line else segment
        here = segment.end


def drill_program(
    holes: Sequence[Point],
    numbers: Numbers,
    *,
    title: str,
    safe_height: float,
    levels: tuple[float, float],
    feed: float,
) -> str:
    """The holes by G81; `levels` are bottom and R level."""
    first, *rest = holes
    drill = f"G81 {numbers.words('XY', first)} {numbers.words('ZRF', [*levels, feed])}"
    lines = [*_head(title, numbers), f"G0 {numbers.words('Z', [safe_height])}", f"G98 {drill}"]
    lines += [numbers.words("XY", hole) for hole in rest]
    return "\n".join([*lines, "G80", "M2", "$I CYCLES.TXT", ""])


def nearest_first(holes: Sequence[Point], epsilon: float) -> list[Point]:
    """Each hole once, the nearest to the one before next, from the origin."""
    unlike = _unlike(holes, epsilon)
    left = Nearest(unlike)
    ordered = []
    here = ORIGIN
    for _ in unlike:
        number, _distance = left.to(here)
        left.take(number)
        here = unlike[number]
        ordered.append(here)
    return ordered


def _unlike(holes: Sequence[Point], epsilon: float) -> list[Point]:
    kept: list[Point] = []
    cells: dict[tuple[int, int], list[Point]] = {}
    for x, y in holes:
        column, row = math.floor(x / epsilon), math.floor(y / epsilon)
        near = [
            other
            for i in (-1, 0, 1)
            for j in (-1, 0, 1)
            for other in cells.get((column + i, row + j), ())
        ]
        if all(math.dist((x, y), other) > epsilon for other in near):
            kept.append((x, y))
            cells.setdefault((column, row), []).append((x, y))
    return kept
