"""What a machine is: its card, unit and axes."""

from typing import Any

from openacr.mill.config.readout import METRIC_MODE, Format
from openacr.panel.control.machine.installation import Installation
from openacr.sysvar import Store
from openacr.sysvar.tabs import AXIS, CONTROL, DISPLAY, GENERAL
from openacr.sysvar.values import ROTARY


def machine_data(installation: Installation) -> dict[str, Any]:
    """The machine as the screens show it."""
    return {
        "kind": installation.kind,
        "name": installation.name,
        "card": installation.store.read_text(GENERAL.card_model),
        "unit": "mm" if installation.store.is_metric else "inch",
        "shown": "mm" if installation.store.read(DISPLAY.control_mode) == METRIC_MODE else "inch",
        "is_small": bool(installation.store.read(CONTROL.position_display)),
        "is_virtual": installation.is_virtual,
        "axes": axes(installation.store),
        "lacks": installation.lacks,
        "attached": [
            {"name": each.name, "index": each.axis, "master": each.master}
            for each in installation.attached
        ],
    }


def axes(store: Store) -> list[dict[str, Any]]:
    """The configured axes as the read-out shows them."""
    unit = "mm" if store.read(CONTROL.default_units) else "inch"
    formats = {"mm": DISPLAY.metric_format, "inch": DISPLAY.inch_format}
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
                "decimals": {
                    each: Format.of(store.read(cells[index])).right
                    for each, cells in formats.items()
                },
                "low": store.read(AXIS.minus_soft_limit[index]) if is_limited else None,
                "high": store.read(AXIS.plus_soft_limit[index]) if is_limited else None,
                "home_required": bool(store.read(AXIS.home_required[index])),
            }
        )
    return found
