"""A part program to be debugged, on the machine of a new store."""

from __future__ import annotations

from pathlib import Path

from openacr.debugger.part_programs.target import PartTarget
from openacr.sysvar import Store

COUNTING = """\
G20 G90 G54 F60
P200=2
N10 P200=P200-1
G1 X(P200)
IF (P200 > 0) THEN GOTO 10

(a comment alone)
GOSUB 100
G4 F0.2
G1 Y0.5
M2
N100 G52 X0.25
G0 Z0.1
RET
"""
SPINDLE = {800_005: 40, 800_007: 43, 800_010: 41, 800_002: 3, 800_001: 0.01}
CUTTING = "M3 S500\nM8\nG1 F600 X300\nM2\n"


def target_of(
    folder: Path, text: str = COUNTING, cells: dict[int, float] | None = None, **options: str
) -> PartTarget:
    file = folder / "part.nc"
    file.write_text(text)
    store = Store()
    for number, value in (cells or {}).items():
        store.write(number, value)
    return PartTarget(file, store, options.get("dialect"), lambda text: None)
