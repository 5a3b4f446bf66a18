"""Run a case on a card."""

from __future__ import annotations

from openacr.conform.facts import suited
from openacr.conform.form import Case, DifferenceError
from openacr.conform.stage import Stage
from openacr.conform.targets import Target, virtual
from openacr.errors import OpenacrError


def run(case: Case, card: Target | None = None, *, model: str = "") -> DifferenceError | None:
    """Run a case on a card, by default on a virtual one as new; what differs first.

    The virtual card is of this model, or of one that has what the case needs.
    """
    if card is not None:
        return _run(case, Stage(card))
    try:
        with virtual(case.machine, case.model or model or suited(case.needs)) as new:
            return _run(case, Stage(new))
    except OpenacrError as error:
        return DifferenceError("a machine that can be loaded", error)


def _run(case: Case, stage: Stage) -> DifferenceError | None:
    try:
        return _steps(case, stage)
    finally:
        stage.close()


def _steps(case: Case, stage: Stage) -> DifferenceError | None:
    for step in case.steps:
        try:
            step.word.act(stage, step, *step.values)
        except DifferenceError as difference:
            difference.at = difference.at or step.at
            return difference
        except OpenacrError as error:
            return DifferenceError("a step that can be done", error, step.at)
    try:
        stage.expect_silence()
        stage.expect_no_alarm()
    except DifferenceError as difference:
        return DifferenceError("(nothing at the end)", difference.shown, case.steps[-1].at)
    return None


def report(case: Case, difference: DifferenceError) -> str:
    """Where a case differs, and how: its file, line, what was expected and shown."""
    line = difference.at.number if difference.at else case.line
    return f'{case.path}:{line}: in "{case.name}"\n{difference}'
