"""Trajectories within a tolerance: times with and without jerk, largest values, CPU time.

Programs of five kinds at 100 mm/s, 1000 mm/s2 and 20,000 mm/s3 by axis. Values are those of the
spline that is sent, which no sample exceeds. Small parts of the programs are compared with the
best motions that are found for path and time together (tests/trajectory/joint_optimum.py). Where
`linuxcnc-uspace` is installed its planner runs the same programs, in real time.
"""

import numpy as np
from tests.trajectory.joint_optimum import Path, fewest
from tests.trajectory.measures import PERIOD_S, deviations, limits, planned, points
from tests.trajectory.programs import KINDS, PARTS, Segments

from bench import linuxcnc
from bench.figures import at_most, best_s, value_only

TOLERANCES_U = (0.01, 0.05)
RATIOS = {"square": 1.06, "corners": 1.15, "pocket": 1.12, "circles": 1.12, "surface": 1.26}
US_PER_SEGMENT = 100.0  # of dense segments, 250 of which come in a second
MS_PER_S = 0.25 * US_PER_SEGMENT  # of motion; the measure for long segments


def main() -> None:
    for kind in KINDS:
        for tolerance in TOLERANCES_U:
            _figures(f"trajectory {kind} {tolerance}", kind, tolerance)
    for kind in PARTS:
        _optima(f"trajectory part of {kind} {TOLERANCES_U[0]}", PARTS[kind](TOLERANCES_U[0]))
    if linuxcnc.is_installed():
        _side_by_side(TOLERANCES_U[0])


def _side_by_side(tolerance: float) -> None:
    """The same programs on LinuxCNC, whose version 2.9 limits no jerk."""
    programs = {kind: make(tolerance) for kind, make in KINDS.items()}
    found = linuxcnc.samples(
        programs, {kind: _start(kind, each) for kind, each in programs.items()}
    )
    for kind, at in found.items():
        name = f"LinuxCNC {kind} {tolerance}"
        value_only(f"{name}: time", len(at) * linuxcnc.PERIOD_S, "s")
        push, jerk = (
            np.nanmax(np.abs(np.diff(at, n, axis=0))) / linuxcnc.PERIOD_S**n for n in (2, 3)
        )
        value_only(f"{name}: largest acceleration", float(push), "mm/s2")
        value_only(f"{name}: largest jerk", float(jerk), "mm/s3")


def _optima(name: str, part: Segments) -> None:
    """How much longer plans take than the joint optimum, and what the jerk costs at least."""
    start, best = (0.0, 0.0, 0.0), {}
    for has_jerk in (True, False):
        plan = points(planned(part, start, limits() if has_jerk else limits(None)))
        best[has_jerk] = len(fewest(Path.of(part, start, PERIOD_S, has_jerk=has_jerk), plan))
        of = f"{name}, {'with' if has_jerk else 'without'} jerk"
        value_only(f"{of}: time / joint optimum", len(plan) / best[has_jerk], "")
    value_only(f"{name}: joint optimum with jerk / plan without", best[True] / len(plan), "")


def _start(kind: str, segments: Segments) -> tuple[float, ...]:
    return segments[0].end if kind == "surface" else (0.0, 0.0, 0.0)


def _figures(name: str, kind: str, tolerance: float) -> None:
    segments = KINDS[kind](tolerance)
    start = _start(kind, segments)
    control = points(planned(segments, start, limits()))
    spent_s = best_s(lambda: planned(segments, start, limits()))
    free = points(planned(segments, start, limits(None)))
    duration, without = len(control) * PERIOD_S, len(free) * PERIOD_S
    value_only(f"{name}: time", duration, "s")
    at_most(f"{name}: time with jerk / without", duration / without, RATIOS[kind], "")
    push, jerk = (np.abs(np.diff(control, n, axis=0)).max() / PERIOD_S**n for n in (2, 3))
    at_most(f"{name}: largest acceleration", float(push), 1000.0 * (1 + 1e-6), "mm/s2")
    at_most(f"{name}: largest jerk", float(jerk), 20_000.0 * (1 + 1e-6), "mm/s3")
    deviation, vertex = deviations(control, segments, start)
    at_most(f"{name}: deviation", max(deviation, vertex), tolerance, "mm")
    per_segment_us = spent_s / len(segments) * 1e6
    if kind == "surface":
        at_most(f"{name}: CPU time per segment", per_segment_us, US_PER_SEGMENT, "us")
    else:
        value_only(f"{name}: CPU time per segment", per_segment_us, "us")
    at_most(f"{name}: CPU time per second of motion", spent_s / duration * 1e3, MS_PER_S, "ms")
