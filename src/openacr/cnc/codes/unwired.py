"""M codes that switch something, and the cells of the store that say what is wired to them."""

from openacr.cnc.state.hosts import Cells
from openacr.sysvar.tabs import CONTROL, IO, SPINDLE

NONE = -1.0
WIRED_BY: dict[str, tuple[int, ...]] = {
    "M3": (SPINDLE.cw_output, SPINDLE.dac),
    "M4": (SPINDLE.ccw_output, SPINDLE.dac),
    "M7": (SPINDLE.coolant_mist_output,),
    "M8": (SPINDLE.coolant_flood_output,),
    **{f"M{12 + k}": (n,) for k, n in enumerate(IO.discrete_output)},
    **{f"M{n}": (CONTROL.tangential_axis,) for n in (595, 597, 598)},
}


def unwired(cells: Cells, code: str) -> str:
    """What would have to be set for an M code to do something; empty where it does."""
    wired_by = WIRED_BY.get(code, ())
    if not wired_by or any(cells.read(cell) != NONE for cell in wired_by):
        return ""
    return f"{code} ({' or '.join(f'P{cell}' for cell in wired_by)})"
