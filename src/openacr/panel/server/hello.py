"""The first words to a browser: who it is, and what the machine is."""

from importlib.metadata import version
from typing import Any

from openacr.io.server import is_loopback
from openacr.panel.control.machine.about import machine_data
from openacr.panel.control.machine.installation import Installation
from openacr.panel.control.operator.hand_motion import LONGEST_AGE_S
from openacr.panel.control.operator.people import Person
from openacr.panel.control.operator.presses import DEAD_MAN_S

MOST_UPLOAD = 256 << 20
KEEP_MS, STALE_MS = 50, 500
MS = 1000.0


def hello(installation: Installation, person: Person, *, has_log_in: bool) -> dict[str, Any]:
    """The event `hello`."""
    return {
        "event": "hello",
        "version": version("openacr"),
        "client": person.client,
        "role": person.role.word,
        "login": has_log_in,
        "local": is_loopback(person.address),
        "machine": machine_data(installation),
        "limits": {
            "text": 64 << 10,
            "upload": MOST_UPLOAD,
            "tick_ms": round(MS * LONGEST_AGE_S),
            "keep_ms": KEEP_MS,
            "dead_man_ms": round(MS * DEAD_MAN_S),
            "stale_ms": STALE_MS,
        },
    }
