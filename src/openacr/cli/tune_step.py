"""`openacr tune step`: what an axis does at a step with the gains it has."""

import json
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from openacr.cli.option_groups import takes
from openacr.cli.tune import ask_to_move, axis_number, card_of, recorded, require_picture
from openacr.cli.tune_options import StepOptions
from openacr.cli.tune_report import step_lines

if TYPE_CHECKING:
    from openacr.tuning.measure import Measurement


@takes(StepOptions)
def record_step(asked: StepOptions) -> None:
    """Move an axis by a step and back, and report its overshoot, rise and settling.

    The axis has to be enabled and at rest. The gains stay as they are.
    """
    excitation = asked.excitation()
    require_picture(asked.plot)
    with card_of(asked.target, asked.baud, asked.silence) as card:
        axis = axis_number(card, asked.axis)
        ask_to_move(asked.is_sure, asked.target, axis, excitation)
        found = recorded(card, axis, excitation, asked.program)
    _report(found, asked.plot, as_json=asked.as_json)


def _report(found: "Measurement", plot: Path | None, *, as_json: bool) -> None:
    from openacr.tuning.curves import curves
    from openacr.tuning.predict import figures

    judged = figures(found.record)
    if plot is not None:
        from openacr.cli.plots.tune_image import write_step

        write_step(found, plot)
    if as_json:
        data = {"axis": found.axis, "figures": asdict(judged), "measured": curves(found.record)[0]}
        typer.echo(json.dumps(data))
        return
    for line in step_lines(found, judged):
        typer.echo(line)
