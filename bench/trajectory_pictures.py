"""Pictures of the pages on smooth paths, drawn from plans of `openacr.trajectory`.

python -m bench.trajectory_pictures [FOLDER]          docs/images by default
"""

import sys
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib import pyplot as plt
from tests.trajectory.measures import PERIOD_S, limits, planned, points
from tests.trajectory.programs import Segments, line, pocket

from openacr.trajectory import evaluate
from openacr.trajectory.path.setpoints import Reals

START = (0.0, 0.0, 0.0)
PER_KNOT = 8


def main() -> None:
    mpl.use("Agg")
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "docs/images")
    corner_passages(folder / "corners.png")
    time_law(folder / "time-law.png")


def motion(segments: Segments) -> tuple[Reals, Reals, Reals, Reals, Reals]:
    """Times, positions, and their three derivatives by time."""
    control = points(planned(segments, START, limits()))
    at = np.arange(0.0, len(control) - 2, 1.0 / PER_KNOT)
    position, *slopes = evaluate(control, at)
    v, a, j = (slope / PERIOD_S**n for n, slope in enumerate(slopes, 1))
    return at * PERIOD_S, position, v, a, j


def corner_passages(path: Path) -> None:
    """How corners of 20 and 90 degrees are passed with three tolerances."""
    figure, axes = plt.subplots(1, 2, figsize=(9.0, 4.0), layout="constrained")
    for axis, turn in zip(axes, (20.0, 90.0), strict=True):
        angle = np.radians(turn)
        end = 10.0 * np.array([1.0 + np.cos(angle), np.sin(angle)])
        reach = 0.45 if turn > 45.0 else 2.0
        axis.plot([-reach, 0.0, reach * np.cos(angle)], [0.0, 0.0, reach * np.sin(angle)],
                  color="black", linewidth=0.8, label="programmed")  # fmt: skip
        for tolerance in (0.1, 0.05, 0.01):
            segments = [line(1, 10, 0, 0, tolerance), line(2, end[0], end[1], 0, tolerance)]
            times, position, v, _, _ = motion(segments)
            near = np.abs(position[:, :2] - (10.0, 0.0)).max(axis=1) < reach
            least = np.linalg.norm(v[near], axis=1).min()
            label = f"{tolerance:g} mm: {times[-1]:.3f} s, {least:.0f} mm/s at least"
            axis.plot(position[near, 0] - 10.0, position[near, 1], linewidth=1.4, label=label)
        axis.set_title(f"corner of {turn:g}°, legs of 10 mm")
        axis.set_xlabel("x from the corner [mm]")
        axis.set_ylabel("y [mm]")
        axis.set_aspect("equal" if turn > 45.0 else "auto")
        axis.grid(alpha=0.3)
        axis.legend(fontsize=8, loc="upper left")
    figure.savefig(path, dpi=110)
    plt.close(figure)


def time_law(path: Path) -> None:
    """Speed, acceleration and jerk over time, along the first half of a pocket's ring."""
    times, _, v, a, j = motion(pocket(0.01)[:5])
    figure, axes = plt.subplots(3, 1, figsize=(9.0, 6.5), sharex=True, layout="constrained")
    axes[0].plot(times, np.linalg.norm(v, axis=1), color="black", label="path")
    rows = ((axes[0], v, 100.0, "speed [mm/s]"), (axes[1], a, 1000.0, "acceleration [mm/s²]"),
            (axes[2], j, 20_000.0, "jerk [mm/s³]"))  # fmt: skip
    for axis, values, most, label in rows:
        for k, name in enumerate("XY"):
            axis.plot(times, values[:, k], linewidth=1.2, label=name)
        for limit in (-most, most):
            axis.axhline(limit, color="0.6", linewidth=0.8, linestyle="--")
        axis.set_ylabel(label)
        axis.grid(alpha=0.3)
    axes[0].legend(fontsize=8, ncols=3)
    axes[2].set_xlabel("time [s]")
    figure.savefig(path, dpi=110)
    plt.close(figure)


if __name__ == "__main__":
    main()
