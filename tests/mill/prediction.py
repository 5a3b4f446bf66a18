"""The predicted time of a list of entries."""

from collections.abc import Iterable

from openacr.cnc import canonical as c
from openacr.mill.config.settings import Settings
from openacr.mill.plan.predicting import Prediction, Predictor


def predicted(
    entries: Iterable[c.Entry],
    settings: Settings,
    begin: c.Point,
    *,
    is_dry: bool = False,
    rounds: bool = True,
) -> Prediction:
    predictor = Predictor(settings, begin, is_dry=is_dry, rounds=rounds)
    for entry in entries:
        predictor.add(entry)
    predictor.rest()
    return predictor.found
