"""`openacr tune step`: what an axis does at a step with the gains it has."""

import json
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from openacr.cli.live.online import BAUD, SILENCE_S, Baud, Silence
from openacr.cli.tune import ask_to_move, card_of, recorded, require_picture
from openacr.cli.tune_options import (
    AMPLITUDE_CNT,
    BY_AMPLITUDE,
    STEP_S,
    Amplitude,
    AsJson,
    AxisNumber,
    IsSure,
    MostError,
    MostTravel,
    Picture,
    Program,
    StepTime,
    Where,
)
from openacr.cli.tune_report import step_lines

if TYPE_CHECKING:
    from openacr.tuning.measure import Measurement


def record_step(
    target: Where,
    axis: AxisNumber,
    amplitude: Amplitude = AMPLITUDE_CNT,
    duration: StepTime = STEP_S,
    max_error: MostError = BY_AMPLITUDE,
    max_travel: MostTravel = BY_AMPLITUDE,
    program: Program = None,
    plot: Picture = None,
    as_json: AsJson = False,
    is_sure: IsSure = False,
    baud: Baud = BAUD,
    silence: Silence = SILENCE_S,
) -> None:
    """Move an axis by a step and back, and report its overshoot, rise and settling.

    The axis has to be enabled and at rest. The gains stay as they are.
    """
    from openacr.tuning.excitation import Excitation

    excitation = Excitation(
        "step",
        amplitude,
        duration_s=duration,
        error_cnt=max_error,
        travel_cnt=max_travel,
    ).checked()
    require_picture(plot)
    with card_of(target, baud, silence) as card:
        ask_to_move(is_sure, target, axis, excitation)
        found = recorded(card, axis, excitation, program)
    _report(found, plot, as_json=as_json)


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
