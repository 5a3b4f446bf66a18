"""The history of a card as the screens get it."""

import math
from typing import Any

from openacr.panel.control.history import History

COARSE_S = 0.5  # of moments while time passes


def timeline_data(history: History, speed: float) -> dict[str, Any]:
    """The branches and bookmarks; what changes with every tick is in `moment_data`."""
    present = history.timeline.branch
    return {
        "period_s": history.period_s,
        "still": history.is_still,
        "away": history.is_away,
        "speed": None if speed == math.inf else speed,
        "branch": present.number,
        "most_bytes": history.most_bytes,
        "branches": [
            {
                "number": each.number,
                "name": history.names[each.number],
                "parent": each.parent,
                "fork": each.fork.tick if each.fork else None,
                "first": each.first.tick,
                "last": None if each is present else each.last.tick,
            }
            for each in history.timeline.branches
        ],
        "bookmarks": [
            {"tick": each.tick, "kind": each.kind.value, "text": each.text}
            for each in history.bookmarks.of(present.number)
            if each.tick >= present.first.tick
        ],
    }


def moment_data(history: History) -> dict[str, Any]:
    """Where the card is in its history: exactly while time is still, else every half second."""
    coarse_tk = 1 if history.is_still else max(1, round(COARSE_S / history.period_s))
    now, last_tk = history.timeline.now, history.last_tk // coarse_tk * coarse_tk
    return {
        "tick": now.tick // coarse_tk * coarse_tk,
        "within": now.within if history.is_still else 0,
        "last": last_tk,
        "bytes": history.size_bytes(last_tk),
    }
