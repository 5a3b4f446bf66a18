"""TEACH: set the zero of a work coordinate system to the present position."""

from collections.abc import Iterable

from openacr.cnc.canonical import Point
from openacr.cnc.geometry.coordinates import origin_that_reads
from openacr.cnc.state.hosts import Cells
from openacr.errors import UserError
from openacr.mill.config.settings import Settings
from openacr.sysvar.tabs import CELLS

CODES = ("G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2")
SYSTEMS = dict(zip(CODES, CELLS.work_systems, strict=True))
ROTATIONS = dict(zip(CODES, CELLS.work_rotations, strict=True))
TURNED = {0, 1}  # axes a rotation about Z mixes


def teach(store: Cells, settings: Settings, code: str, here: Point, axes: Iterable[int]) -> None:
    """Set the offsets of a work system so that machine position `here` reads 0 along these axes.

    The common shift stays in effect: it is subtracted from the position. Where the system is
    rotated, X or Y alone moves both of its offsets, and the other one reads what it read.
    All axes are stored in one transaction.
    """
    if code.upper() not in SYSTEMS:
        raise UserError(f"{code}: work systems are {' '.join(SYSTEMS)}")
    chosen = [settings.axis(axis) for axis in axes]
    for axis in chosen:
        if axis.is_home_required and not settings.is_homed(axis.index):
            raise UserError(f"axis {axis.name} is not homed: its position is not valid yet")
    cells = SYSTEMS[code.upper()]
    before = tuple(store.read(cell) for cell in cells)
    own = tuple(x - store.read(cell) for x, cell in zip(here, CELLS.common_work_shift, strict=True))
    degrees = store.read(ROTATIONS[code.upper()])
    origin = origin_that_reads(own, before, degrees, {axis.index: 0.0 for axis in chosen})
    with store.transaction():
        for index in {axis.index for axis in chosen} | (TURNED if degrees else set()):
            store.write(cells[index], origin[index])
