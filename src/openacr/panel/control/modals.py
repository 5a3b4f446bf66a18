"""The modal state of an interpreter as codes, one for each group."""

from typing import Any

from openacr.cnc.canonical import Spin
from openacr.cnc.interpreter.interpreter import Interpreter
from openacr.mill.session import MillSession
from openacr.sysvar.tabs import CELLS

SYSTEMS = ("G53", "G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3")
NO_CYCLE = 80


def modals(session: MillSession, run: Interpreter) -> dict[str, Any]:
    """Codes and words in force in the block that is read."""
    modal, read = run.modal, session.cells.read
    motion = modal.cycle if modal.cycle != NO_CYCLE else modal.motion
    work = SYSTEMS[modal.work] if modal.work < len(SYSTEMS) else "G54"
    codes = [
        f"G{motion:g}",
        f"G{modal.plane}",
        f"G{modal.unit}",
        f"G{modal.distance}",
        f"G{modal.feed_mode}",
        f"G{modal.compensation}",
        f"G{modal.length}",
        work,
        f"G{modal.path}",
        f"G{modal.return_level}",
    ]
    return {
        "codes": codes,
        "F": modal.feed,
        "S": modal.speed,
        "T": modal.tool,
        "D": modal.radius_number,
        "H": modal.length_number,
        "spindle": int(read(CELLS.spindle_state)),
        "coolant": int(read(CELLS.coolant_state)),
        "is_spinning": modal.spin is not Spin.OFF,
        "work": work,
    }
