"""A reader of the few blocks an imported program has, apart from the one under test."""

import math
import re
from dataclasses import dataclass, field

Point = tuple[float, float]
WORD = re.compile(r"([A-Z])(-?[0-9.]+)")


@dataclass
class Traced:
    """What the tool does: runs at cutting depth as points, holes, blocks."""

    runs: list[list[Point]] = field(default_factory=list)
    length: float = 0.0
    codes: list[int] = field(default_factory=list)


def trace(text: str, step_deg: float = 0.5) -> Traced:
    """Follow the program; arcs become points every `step_deg`."""
    traced = Traced()
    here: Point = (math.nan, math.nan)
    depth = math.inf
    for line in text.splitlines():
        if line.startswith(";"):
            continue
        words = {letter: float(number) for letter, number in WORD.findall(line)}
        code = int(words.get("G", -1))
        to = (words.get("X", here[0]), words.get("Y", here[1]))
        if "Z" in words:
            depth = words["Z"]
            if depth == 0:
                traced.runs.append([here])
        elif code in (1, 2, 3) and depth == 0:
            traced.codes.append(code)
            points = [to] if code == 1 else _arc(here, to, (words["I"], words["J"]), code, step_deg)
            for point in points:
                traced.length += math.dist(here, point)
                traced.runs[-1].append(point)
                here = point
        here = to
    return traced


def _arc(start: Point, end: Point, centre: Point, code: int, step_deg: float) -> list[Point]:
    a0 = math.atan2(start[1] - centre[1], start[0] - centre[0])
    a1 = math.atan2(end[1] - centre[1], end[0] - centre[0])
    full = 2 * math.pi
    sweep = ((a1 - a0) % full or full) if code == 3 else -((a0 - a1) % full or full)
    if start == end:
        sweep = full if code == 3 else -full
    count = max(2, round(abs(math.degrees(sweep)) / step_deg))
    r0, r1 = math.dist(start, centre), math.dist(end, centre)
    points = []
    for k in range(1, count):
        angle, r = a0 + sweep * k / count, r0 + (r1 - r0) * k / count
        points.append((centre[0] + r * math.cos(angle), centre[1] + r * math.sin(angle)))
    return [*points, end]
