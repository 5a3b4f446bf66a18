"""The first words to a browser: who it is, and what the machine is."""

from typing import TYPE_CHECKING, Any

from openacr.panel.control.about import machine_data
from openacr.panel.control.hand_motion import LONGEST_AGE_S
from openacr.panel.control.people import Person
from openacr.panel.control.presses import DEAD_MAN_S

if TYPE_CHECKING:
    from openacr.panel.server.panel import Panel

MOST_UPLOAD = 256 << 20
KEEP_MS, STALE_MS = 50, 500
MS = 1000.0


def hello(panel: "Panel", person: Person, version: str) -> dict[str, Any]:
    """The event `hello`."""
    return {
        "event": "hello",
        "version": version,
        "client": person.client,
        "role": person.role.word,
        "login": panel.accounts.are_asked,
        "machine": machine_data(panel.installation),
        "limits": {
            "text": 64 << 10,
            "upload": MOST_UPLOAD,
            "tick_ms": round(MS * LONGEST_AGE_S),
            "keep_ms": KEEP_MS,
            "dead_man_ms": round(MS * DEAD_MAN_S),
            "stale_ms": STALE_MS,
        },
    }
