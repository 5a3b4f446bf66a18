"""The modal state of an interpreter as codes, one for each group."""

from typing import Any

from openacr.cnc.canonical import Spin
from openacr.cnc.interpreter.interpreter import Interpreter
from openacr.mill.session import MillSession


def modals(session: MillSession, run: Interpreter) -> dict[str, Any]:
    """Codes and words in force in the block that is read."""
    modal, actions = run.modal, session.runner.entry_actions
    return {
        "codes": modal.codes,
        "F": modal.feed,
        "S": modal.speed,
        "T": modal.tool,
        "D": modal.radius_number,
        "H": modal.length_number,
        "spindle": actions.spindle.state,
        "coolant": actions.coolant.has_mist + 2 * actions.coolant.has_flood,
        "is_spinning": modal.spin is not Spin.OFF,
        "work": modal.work_code,
    }
