"""The processes that compute for the screens: programs read, motors identified."""

from openacr.workers import Background
from openacr.workers.background import NICER

PRELOAD = "openacr.panel.work.paths"  # importing what reads programs takes half a second
KILLED = "the program is too big for the memory of this computer, or its reading was killed"


def process(nicer: int = NICER, killed: str = KILLED) -> Background:
    """A process that starts soon after the first one of the panel."""
    return Background(killed, nicer, PRELOAD)
