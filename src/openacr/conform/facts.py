"""What the model of a card must have for a case: `needs: user flash, at most 8 axes`."""

from __future__ import annotations

import re
from collections.abc import Iterable

from openacr.models import DEFAULT_MODEL, MODELS, Feature, Model

FEATURES = {
    "NURBs": Feature.NURBS,
    "look-ahead": Feature.LOOK_AHEAD,
    "user flash": Feature.USER_FLASH,
}
COUNTS = {
    "axes": "axes",
    "inputs": "lines",  # digital; as many outputs
    "masters": "masters",
    "encoders": "encoders",
    "analog inputs": "adcs",
    "analog outputs": "dacs",
    "commutators": "commutators",
}
BATTERY = {"battery": True, "no battery": False}
_COUNT = re.compile(rf"at (least|most) (\d+) ({'|'.join(COUNTS)})")


def needs_of(text: str) -> tuple[str, ...]:
    """The facts of a line, none of an empty one; ValueError for one that there is not."""
    facts = tuple(each.strip() for each in text.split(",")) if text else ()
    for fact in facts:
        if fact not in FEATURES | BATTERY and not _COUNT.fullmatch(fact):
            known = ", ".join([*FEATURES, *BATTERY])
            raise ValueError(f"expected {known}, at least or at most N of {', '.join(COUNTS)}")
    return facts


def lacking(facts: Iterable[str], model: Model) -> str:
    """Which of the facts a model has not, in words; empty if it has all."""
    missing = [fact for fact in facts if not _has(model, fact)]
    return f"it needs {' and '.join(missing)}: not of the {model.name}" if missing else ""


def suited(facts: Iterable[str]) -> str:
    """The name of a model that has the facts, by preference the default one."""
    wanted = tuple(facts)
    rows = (DEFAULT_MODEL, *MODELS.values())
    return next((each.name for each in rows if not lacking(wanted, each)), DEFAULT_MODEL.name)


def _has(model: Model, fact: str) -> bool:
    if fact in BATTERY:
        return model.has_battery is BATTERY[fact]
    if fact in FEATURES:
        return FEATURES[fact] not in model.lacks
    found = _COUNT.fullmatch(fact)
    if found is None:
        raise ValueError(fact)
    count: int = getattr(model, COUNTS[found[3]])
    return count >= int(found[2]) if found[1] == "least" else count <= int(found[2])
