"""Why a debugged card stops."""

from dataclasses import dataclass
from enum import StrEnum


class Reason(StrEnum):
    """Why a debugged card stands."""

    ENTRY = "entry"
    BREAKPOINT = "breakpoint"
    DATA = "data breakpoint"
    STEP = "step"
    PAUSE = "pause"
    EXCEPTION = "exception"
    GOTO = "goto"
    END = "end"


@dataclass(frozen=True, slots=True)
class Stop:
    """Why the card stands, at which program if that is known, with a sentence."""

    reason: Reason
    program: int | None = None
    text: str = ""
