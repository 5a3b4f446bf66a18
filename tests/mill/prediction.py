"""What is planned: the time of a list of entries, the speed in a corner."""

from collections.abc import Iterable

from msgspec.structs import replace

from openacr.cnc import canonical as c
from openacr.mill.config.settings import Settings
from openacr.mill.plan.estimate.predicting import Prediction, Predictor
from openacr.mill.plan.moves.planning import CornerRules, PlannedMove, Planner


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


def corner_speed(before: PlannedMove, after: PlannedMove, rules: CornerRules) -> float:
    """The speed from one move into the next, which is long enough to brake."""
    planner: Planner[PlannedMove] = Planner(rules)
    planner.add(replace(before))
    planner.add(replace(after, length_u=1e6))
    return next(planner.release(1, is_complete=True)).exit_ups
