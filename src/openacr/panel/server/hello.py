"""The first words to a browser: who it is, and what the machine is."""

from typing import TYPE_CHECKING, Any

from openacr.panel.control.hands import LONGEST_AGE_S
from openacr.panel.control.people import Person
from openacr.panel.control.presses import DEAD_MAN_S
from openacr.sysvar import Store
from openacr.sysvar.tabs import AXIS, CONTROL, DISPLAY, GENERAL
from openacr.sysvar.values import ROTARY

if TYPE_CHECKING:
    from openacr.panel.server.panel import Panel

MOST_UPLOAD = 256 << 20
KEEP_MS, STALE_MS = 50, 500
MS = 1000.0


def hello(panel: "Panel", person: Person, version: str) -> dict[str, Any]:
    """The event `hello`."""
    bench = panel.bench
    return {
        "event": "hello",
        "version": version,
        "client": person.client,
        "role": person.role.word,
        "login": panel.accounts.are_asked,
        "machine": {
            "kind": bench.kind,
            "name": bench.name,
            "card": bench.store.read_text(GENERAL.card_model),
            "unit": "mm" if bench.store.is_metric else "inch",
            "is_virtual": bench.is_virtual,
            "axes": axes(bench.store),
        },
        "limits": {
            "text": 64 << 10,
            "upload": MOST_UPLOAD,
            "tick_ms": round(MS * LONGEST_AGE_S),
            "keep_ms": KEEP_MS,
            "dead_man_ms": round(MS * DEAD_MAN_S),
            "stale_ms": STALE_MS,
        },
    }


def axes(store: Store) -> list[dict[str, Any]]:
    """The configured axes as the read-out shows them."""
    unit = "mm" if store.read(CONTROL.default_units) else "inch"
    formats = DISPLAY.metric_format if unit == "mm" else DISPLAY.inch_format
    found = []
    for index in range(8):
        if not store.read(AXIS.configured[index]):
            continue
        name = store.read_text(AXIS.name[index])
        is_limited = not store.read(AXIS.disable_limit[index])
        found.append(
            {
                "name": name,
                "index": index,
                "unit": "deg" if name in ROTARY else unit,
                "decimals": round(10.0 * store.read(formats[index])) % 10,
                "low": store.read(AXIS.minus_soft_limit[index]) if is_limited else None,
                "high": store.read(AXIS.plus_soft_limit[index]) if is_limited else None,
                "home_required": bool(store.read(AXIS.home_required[index])),
            }
        )
    return found
