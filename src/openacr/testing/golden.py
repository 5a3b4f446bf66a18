"""Golden traces: what the axes did, compared with a file that was looked at once."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from openacr.testing.machine import Machine

DIGITS = 9
UPDATE = "--openacr-update writes it"


@dataclass(slots=True)
class Golden:
    """Compares the recording of a machine with a file, or writes it."""

    machine: Machine
    path: Path  # without the suffix
    is_updated: bool = False

    def check(self, *axes: int, tolerance_u: float = 1e-6, name: str = "") -> None:
        """Compare the positions of axes over the whole test; AssertionError where they differ.

        `tolerance_u` in units of the axes. Several checks of a test need names.
        """
        path = self.path.with_name(f"{self.path.name}{'-' if name else ''}{name}.csv")
        present = self._rows(axes)
        if self.is_updated:
            path.parent.mkdir(parents=True, exist_ok=True)
            head = ",".join(["time_s", *(f"axis{number}_u" for number in axes)])
            np.savetxt(path, present, f"%.{DIGITS}g", ",", header=head, comments="")
            return
        if not path.exists():
            raise AssertionError(f"there is no golden trace {path}: {UPDATE}")
        kept = np.loadtxt(path, delimiter=",", skiprows=1, ndmin=2)
        self._compare(path, kept, present, axes, tolerance_u)

    def _rows(self, axes: tuple[int, ...]) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
        traces = self.machine.recorded()
        columns = [np.concatenate([trace.time_s for trace in traces])]
        columns += [
            np.concatenate([trace.axes[number].commanded_u for trace in traces]) for number in axes
        ]
        return np.column_stack(columns)

    @staticmethod
    def _compare(
        path: Path,
        kept: np.ndarray[tuple[int, int], np.dtype[np.float64]],
        present: np.ndarray[tuple[int, int], np.dtype[np.float64]],
        axes: tuple[int, ...],
        tolerance_u: float,
    ) -> None:
        if kept.shape != present.shape:
            raise AssertionError(
                f"{path} has {kept.shape[0]} rows of {kept.shape[1]} values, this test made"
                f" {present.shape[0]} of {present.shape[1]} ({UPDATE})"
            )
        for column, number in enumerate(axes, start=1):
            apart = np.abs(kept[:, column] - present[:, column])
            if apart.max() > tolerance_u:
                row = int(np.argmax(apart > tolerance_u))
                raise AssertionError(
                    f"{path}: axis {number} at {present[row, 0]:.4f} s is {present[row, column]:g},"
                    f" it was {kept[row, column]:g}; at most {apart.max():g} apart ({UPDATE})"
                )
