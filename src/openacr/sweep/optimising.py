"""The search for values that give the least measure: Optuna, with a bound for each quantity."""

from __future__ import annotations

import math
from typing import Any

from openacr.errors import UserError
from openacr.sweep.schema import Scale
from openacr.sweep.study import Point, Study

TOGETHER = 8  # trials that are asked for before their results are known


class Search:
    """Trials in batches; the seed and the results alone decide which values come next."""

    def __init__(self, study: Study) -> None:
        optuna = _optuna()
        optuna.logging.set_verbosity(optuna.logging.WARNING)
        self._study = study
        if study.optimise is None:
            raise UserError("[optimise] is missing")
        wanted = study.optimise
        self.trials = wanted.trials
        self._left = wanted.trials
        self._fail = optuna.trial.TrialState.FAIL
        self._spaces = self._distributions(optuna)
        self._search: Any = optuna.create_study(
            direction="minimize" if wanted.minimise else "maximize",
            sampler=optuna.samplers.TPESampler(seed=wanted.seed, n_startup_trials=2 * TOGETHER),
        )
        self._asked: list[Any] = []

    def _distributions(self, optuna: Any) -> dict[str, Any]:
        found = {}
        for name, quantity in self._study.quantities.items():
            if quantity.values is not None:
                found[name] = optuna.distributions.CategoricalDistribution(quantity.values)
                continue
            low, high = quantity.range or (0.0, 1.0)
            is_log = quantity.scale is Scale.LOG
            found[name] = optuna.distributions.FloatDistribution(low, high, log=is_log)
        return found

    def ask(self) -> list[Point]:
        """The next points; none when all trials are done."""
        count = min(TOGETHER, self._left)
        self._left -= count
        self._asked = [self._search.ask(self._spaces) for _ in range(count)]
        return [
            tuple(float(trial.params[name]) for name in self._study.quantities)
            for trial in self._asked
        ]

    def answer(self, measures: list[float]) -> None:
        """The measures of the points asked for last; NaN of a run without one."""
        for trial, measure in zip(self._asked, measures, strict=True):
            if math.isfinite(measure):
                self._search.tell(trial, measure)
            else:
                self._search.tell(trial, state=self._fail)


def _optuna() -> Any:
    try:
        import optuna
    except ImportError:
        raise UserError("[optimise] needs Optuna: pip install 'openacr[sweep]'") from None
    return optuna
