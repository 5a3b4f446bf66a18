"""M codes that switch something, and the cells of the store that say what is wired to them."""

from openacr.cnc.state.hosts import Cells

NONE = -1.0
SPINDLE_DAC, SPINDLE_CW, SPINDLE_CCW, MIST, FLOOD = 800_002, 800_005, 800_006, 800_009, 800_010
TANGENTIAL_AXIS, FIRST_DISCRETE = 250_112, 400_101
WIRED_BY: dict[str, tuple[int, ...]] = {
    "M3": (SPINDLE_CW, SPINDLE_DAC),
    "M4": (SPINDLE_CCW, SPINDLE_DAC),
    "M7": (MIST,),
    "M8": (FLOOD,),
    **{f"M{12 + k}": (FIRST_DISCRETE + k,) for k in range(13)},
    **{f"M{n}": (TANGENTIAL_AXIS,) for n in (595, 597, 598)},
}


def unwired(cells: Cells, code: str) -> str:
    """What would have to be set for an M code to do something; empty where it does."""
    wired_by = WIRED_BY.get(code, ())
    if not wired_by or any(cells.read(cell) != NONE for cell in wired_by):
        return ""
    return f"{code} ({' or '.join(f'P{cell}' for cell in wired_by)})"
