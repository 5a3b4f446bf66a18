"""`openacr tune apply` and `undo`: set the proposed gains of an axis, or the former ones again."""

import json
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

import typer

from openacr.cli.live.online import BAUD, FAILED, SILENCE_S, Baud, Silence
from openacr.cli.option_groups import takes
from openacr.cli.tune import advised, ask_to_move, axis_number, card_of, report
from openacr.cli.tune_options import STEP_S, ApplyOptions, Where
from openacr.errors import UserError


@takes(ApplyOptions)
def apply_gains(asked: ApplyOptions) -> None:
    """Measure an axis, propose gains, show what they would do, and set them when confirmed.

    The card tries them with a step and sets the former ones again where a bound is exceeded or
    the axis does not come to rest. The former gains are kept in a file, for `openacr tune undo`.
    Set-up files and what ESAVE keeps are not changed.
    """
    from openacr.tuning.advice import new_filters
    from openacr.tuning.excitation import Excitation
    from openacr.tuning.measure import measure

    target, keep = asked.target, asked.keep
    if Path(target).exists():
        raise UserError(
            f"{target} is a project: put the lines that `propose` prints into its files"
        )
    if keep.exists():
        raise UserError(f"{keep} exists: choose another file for the former gains (--keep)")
    excitation = asked.excitation()
    with card_of(target, asked.baud, asked.silence) as card:
        axis = axis_number(card, asked.axis)
        ask_to_move(asked.is_sure, target, axis, excitation)
        advice = advised(card, axis, excitation, asked.program, asked.wish(), None)
        report(advice, None, as_json=False, with_proposal=True)
        if advice.proposal is None:
            raise typer.Exit(FAILED)
        if not asked.is_sure:
            typer.confirm(f"Set these gains of axis {axis} and try them with a step?", abort=True)
        settings, filters = advice.measurement.settings, new_filters(advice)
        former: dict[str, Any] = {"axis": axis, "gains": settings.gains}
        if filters is not None and settings.filters is not None:
            former["filters"] = asdict(settings.filters)
        _write(keep, json.dumps(former, indent=1) + "\n")
        trial = Excitation(
            "step",
            excitation.height_cnt,
            duration_s=STEP_S,
            error_cnt=excitation.error_cnt,
            travel_cnt=excitation.travel_cnt,
        )
        gains = advice.proposal.gains
        try:
            card.perform(
                lambda talk: measure(
                    talk, axis, trial, gains=gains, filters=filters, program=asked.program
                )
            )
        except UserError:  # the card has the former gains
            keep.unlink()
            raise
    typer.echo(f"set; the former gains are in {keep}: openacr tune undo {target} {keep}")


def undo_gains(
    target: Where,
    kept: Annotated[Path, typer.Argument(metavar="FILE", help="The file of `apply`.")],
    baud: Baud = BAUD,
    silence: Silence = SILENCE_S,
) -> None:
    """Set the gains again that an axis had before `openacr tune apply`."""
    from openacr.tuning.filters import Filters
    from openacr.tuning.measure import require_rest, write_gains
    from openacr.tuning.settings import GAINS

    try:
        found = json.loads(kept.read_text("utf-8"))
        axis = int(found["axis"])
        gains = {word: float(found["gains"][word]) for word in GAINS}
        filters = Filters(**found["filters"]) if "filters" in found else None
    except OSError as failed:
        raise UserError(f"{kept}: {failed.strerror}") from None
    except (ValueError, KeyError, TypeError):
        raise UserError(f"{kept}: not a file of `openacr tune apply`") from None
    with card_of(target, baud, silence) as card:
        card.perform(lambda talk: require_rest(talk, axis))
        card.perform(lambda talk: write_gains(talk, axis, gains, filters))
    typer.echo(f"axis {axis}: " + " ".join(f"{word} {value:.7G}" for word, value in gains.items()))


def _write(path: Path, text: str) -> None:
    try:
        path.write_text(text, "utf-8")
    except OSError as failed:
        raise UserError(f"{path}: {failed.strerror}") from None
