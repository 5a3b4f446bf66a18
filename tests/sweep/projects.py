"""Small projects and sweeps of them, and a pool without processes."""

from collections.abc import Iterable, Iterator
from pathlib import Path

from openacr.closing import Closing
from openacr.sweep.campaign import Campaign, Progress
from openacr.sweep.load import load_sweep
from openacr.sweep.results import Results, Row
from openacr.workers import Call, Done, Lost, Pool
from openacr.workers.calls import Result, Task

MACHINE = """
[card]
model = "ACR9000"

[[axis]]
number = 2
name = "X"
encoder_lines = 1024
units_per_rev = 1.0

[axis.motor]
inertia_kgm2 = 2.0e-5
torque_nm_per_a = 0.0771

[axis.load]
viscous_nms = 1.5e-4

[axis.drive]
mode = "torque"
amps_per_volt = 2.0
peak_amps = 20.0

[[wire]]
name = "far"
input = 20
region = { X = [1.5, 100.0] }
"""
SETUP = """
SYS
DIM PROG0(4096)
DIM P(16)
DIM DEF(10)
#DEFINE DISTANCE 2
ATTACH AXIS2 ENC2 DAC2 ENC2
ENC2 MULT 4
AXIS2 ON
PROG0
ATTACH MASTER0
ATTACH SLAVE0 AXIS2 "X"
PPU X4096
EXC X4
ACC 100 DEC 100 STP 100 VEL 20
PGAIN X0.05 : DGAIN X0.00021
RES X
DRIVE ON X
"""
MOVE = """
PROGRAM
X(DISTANCE)
INH -516
P5=P12802
ENDP
"""
FORMULA = """
PROGRAM
P3=SIN(P0*57.29577951308232)
P4=SIN(P1*57.29577951308232)
P5=P3+7*P4*P4+0.1*P2*P2*P2*P2*P3
ENDP
"""


class Here(Closing):
    """Does the tasks in this process, one after the other."""

    size = 1
    deaths = 0

    def close(self) -> None:
        """Nothing is open."""

    def results(
        self, call: Call[Task, Result], tasks: Iterable[Task]
    ) -> Iterator[Done[Task, Result] | Lost[Task]]:
        for task in tasks:
            yield Done(task, call(task))


def axis_project(folder: Path) -> Path:
    """A motor that makes one move, whose length is a define."""
    return _project(folder, {"machine.toml": MACHINE, "setup.8k": SETUP, "prog0.8k": MOVE})


def formula_project(folder: Path) -> Path:
    """A program that computes P5 of P0, P1 and P2."""
    return _project(folder, {"setup.8k": "SYS\nDIM PROG0(2000)\nDIM P(10)\n", "prog0.8k": FORMULA})


def _project(folder: Path, files: dict[str, str]) -> Path:
    folder.mkdir()
    for name, text in files.items():
        (folder / name).write_text(text)
    return folder


def sweep_file(folder: Path, text: str, name: str = "study.toml") -> Path:
    """A sweep of the project `p` beside it."""
    path = folder / name
    path.write_text(f'project = "p"\n{text}')
    return path


def rows_of(
    file: Path,
    pool: Pool | None = None,
    progress: Progress | None = None,
    output: Path | None = None,
) -> list[Row]:
    """Do a sweep; its rows in the order of their runs."""
    study = load_sweep(file)
    results = Results(output or file.with_suffix(".parquet"), study)
    try:
        with pool or Here() as workers:
            return Campaign(study, results, workers, progress or Progress()).run()
    finally:
        results.close()
