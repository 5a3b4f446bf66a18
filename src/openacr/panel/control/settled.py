"""Which stored cells count only from the next session of the machine."""

from openacr.sysvar.lookup import known
from openacr.sysvar.schema import FIRST_SYSTEM
from openacr.sysvar.tabs import (
    AXIS,
    COMPATIBILITY,
    CONTROL,
    FOV,
    GENERAL,
    HOME,
    IO,
    JOG,
    MESSAGES,
    OFFSETS,
    PROBE,
    ROV,
    SERVO,
    SOV,
    SPEEDS,
    SPINDLE,
    TOOL,
)

# Tabs that a session reads when it is opened.
OF_SESSION = frozenset(
    tab.tab.name
    for tab in (
        AXIS, COMPATIBILITY, CONTROL, FOV, HOME, IO, JOG, MESSAGES, OFFSETS, PROBE, ROV, SERVO,
        SOV, SPEEDS, SPINDLE, TOOL,
    )
)  # fmt: skip
OF_CARD = frozenset({GENERAL.card_model, GENERAL.axis_count, GENERAL.master_program})


def is_of_session(cell: int) -> bool:
    """Whether the machine has to be set up again after this cell was stored."""
    if cell < FIRST_SYSTEM:
        return False
    return cell in OF_CARD or known(cell).tab in OF_SESSION
