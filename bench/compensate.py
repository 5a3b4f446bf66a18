"""Segments per second that cutter radius compensation leads a tool along."""

import random
from math import cos, pi, sin

from bench.figures import at_least, best_s, value_only
from bench.interpret import interpreted
from openacr.cnc.canonical import Pace, Plane, Source
from openacr.cnc.compensation import ChainCheck, Compensator, Rules, Side
from openacr.cnc.geometry.elements import Element

SEGMENTS = 50_000
LINES = 10_000
RADIUS = 0.05
TARGET = 100_000.0
REST = (0.0,) * 6


def contour() -> list[Element]:
    """Lines of a wavy contour, every fifth one an arc, with inside and outside corners."""
    rnd = random.Random(1)
    source, pace = Source("bench", 1, ""), Pace(10.0)
    elements = []
    x = y = 0.0
    for k in range(SEGMENTS):
        heading = rnd.uniform(-0.6, 0.6)
        start = (x, y, *REST)
        if k % 5 == 4:
            cx, cy = x - sin(heading), y + cos(heading)
            x, y = cx + cos(heading), cy + sin(heading)
            end = (x, y, *REST)
            elements.append(Element(source, Plane.XY, start, end, pace, (cx, cy), pi / 2))
            continue
        x, y = x + cos(heading), y + sin(heading)
        elements.append(Element(source, Plane.XY, start, (x, y, *REST), pace))
    return elements


def run(elements: list[Element], watch: ChainCheck | None = None) -> int:
    findings: list[str] = []
    compensator: Compensator[str] = Compensator(
        Rules(), lambda code, text, element: findings.append(code), watch
    )
    compensator.switch(Side.LEFT, RADIUS)
    count = sum(len(compensator.add(element)) for element in elements)
    return count + len(compensator.stop())


def program(lines: int) -> str:
    """Straight lines of a contour under G41, as text."""
    rows = [f"X{n / 10:.1f} Y{n % 2 / 100:.2f}" for n in range(1, lines)]
    return "\n".join(["F100", "P1998=.05", "G41 G1 X0", *rows, "G40 Y5", "M2"])


def main() -> None:
    elements = contour()
    seconds = best_s(lambda: run(elements), 3)
    at_least("segments compensated per second", len(elements) / seconds, TARGET, "1/s")
    seconds = best_s(lambda: run(elements, ChainCheck(1e-3, lambda *finding: None)), 1)
    value_only("segments compensated and checked as a whole", len(elements) / seconds, "1/s")
    seconds = best_s(lambda: interpreted(program(LINES)), 1)
    value_only("lines of a program read and compensated", LINES / seconds, "1/s")


if __name__ == "__main__":
    main()
