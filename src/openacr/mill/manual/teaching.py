"""TEACH: set the zero of a work coordinate system to the present position."""

from collections.abc import Iterable

from openacr.cnc.canonical import Point
from openacr.cnc.state.hosts import Cells
from openacr.errors import UserError
from openacr.mill.config.settings import Settings
from openacr.sysvar.tabs import CELLS

CODES = ("G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2")
SYSTEMS = dict(zip(CODES, CELLS.work_systems, strict=True))


def teach(store: Cells, settings: Settings, code: str, here: Point, axes: Iterable[int]) -> None:
    """Set the offsets of a work system so that machine position `here` reads 0 along these axes.

    The common shift stays in effect: it is subtracted from the position.
    All axes are stored in one transaction.
    """
    if code.upper() not in SYSTEMS:
        raise UserError(f"{code}: work systems are {' '.join(SYSTEMS)}")
    chosen = [settings.axis(axis) for axis in axes]
    for axis in chosen:
        if axis.is_home_required and not settings.is_homed(axis.index):
            raise UserError(f"axis {axis.name} is not homed: its position is not valid yet")
    system = SYSTEMS[code.upper()]
    with store.transaction():
        for axis in chosen:
            shift = here[axis.index] - store.read(CELLS.common_work_shift[axis.index])
            store.write(system[axis.index], shift)
