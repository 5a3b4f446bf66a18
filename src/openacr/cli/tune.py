"""`openacr tune`: measure an axis and propose gains for it."""

import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from openacr.cli.live.online import FAILED, connected, progress_bar
from openacr.cli.option_groups import takes
from openacr.cli.tune_options import AXES, MeasureOptions, ProposeOptions
from openacr.errors import UserError

if TYPE_CHECKING:
    from openacr.client import Card
    from openacr.tuning.advice import Advice, Move
    from openacr.tuning.excitation import Excitation
    from openacr.tuning.measure import Measurement
    from openacr.tuning.propose import Wish


@takes(MeasureOptions)
def measure_axis(asked: MeasureOptions) -> None:
    """Move an axis by a sine sweep, identify its motor and judge its present gains.

    The axis has to be enabled and at rest. The card does it by itself, in an empty program that is
    erased afterwards, and ends it where a bound is exceeded.
    """
    excitation = asked.excitation()
    require_picture(asked.plot)
    with card_of(asked.target, asked.baud, asked.silence) as card:
        axis = axis_number(card, asked.axis)
        ask_to_move(asked.is_sure, asked.target, axis, excitation)
        advice = advised(card, axis, excitation, asked.program, None, None)
    report(advice, asked.plot, as_json=asked.as_json, with_proposal=False)


@takes(ProposeOptions)
def propose_gains(asked: ProposeOptions) -> None:
    """Measure an axis and propose gains, beside what they would do; nothing is set."""
    excitation = asked.excitation()
    require_picture(asked.plot)
    with card_of(asked.target, asked.baud, asked.silence) as card:
        axis = axis_number(card, asked.axis)
        ask_to_move(asked.is_sure, asked.target, axis, excitation)
        wanted = _move(card, axis, asked.move)
        advice = advised(card, axis, excitation, asked.program, asked.wish(), wanted)
    report(advice, asked.plot, as_json=asked.as_json, with_proposal=True)


def require_picture(plot: Path | None) -> None:
    """Refuse a picture that could not be drawn, before the axis moves."""
    from openacr.cli.plots import IMAGES, require

    if plot is not None:
        require(plot, "of tuning", IMAGES)


# --- parts of these ---------------------------------------------------------------------


def _move(card: "Card", axis: int, move: tuple[float, float, float] | None) -> "Move | None":
    """A move in pulses."""
    from openacr.tuning.advice import Move

    if not move:
        return None
    scale = abs(float(card.axis(axis).ppu)) or 1.0
    return Move(*(value * scale for value in move))


@contextmanager
def card_of(target: str, baud: int, silence_s: float) -> "Iterator[Card]":
    """The card at a host, or a virtual one with a project, its drives enabled."""
    if not Path(target).exists() or target.startswith(("/dev/", "//")):
        with connected(target, baud, silence_s) as card:
            yield card
        return
    from openacr.client import Card, RefusedError
    from openacr.controller import Controller

    host = Controller.from_project(target)
    try:
        with Card.open(host) as card:
            for number in range(AXES):
                try:
                    card.command(f"AXIS{number} DRIVE ON")
                except RefusedError:
                    break
            card.pause(0.5)
            yield card
    finally:
        host.close()


def axis_number(card: "Card", text: str) -> int:
    """The axis of a number, or of the name by which a program of the card calls it."""
    from openacr.configure.queries import PROGRAMS, attached_master

    if text.isdecimal() and int(text) < AXES:
        return int(text)
    names = {
        name.upper(): axis
        for program in reversed(PROGRAMS)
        for name, axis in attached_master(card, program)[1].items()
    }
    if text.upper() not in names:
        known = f" or {', '.join(sorted(names))}" if names else ""
        raise UserError(f"AXIS {text}: give a number from 0 to {AXES - 1}{known}")
    return names[text.upper()]


def ask_to_move(is_sure: bool, target: str, axis: int, excitation: "Excitation") -> None:
    """Ask before an axis of a real or served card moves."""
    import sys

    if is_sure or Path(target).exists():
        return
    sweep = f" to both sides, {excitation.low_hz:g} to {excitation.high_hz:g} Hz,"
    text = (
        f"axis {axis} of {target} will move by {excitation.height_cnt:g} pulses"
        f"{sweep if excitation.kind == 'sine' else ' and back,'} for {excitation.duration_s:g} s"
        f"{' at most' if excitation.is_shortened else ''}"
    )
    if not sys.stdin.isatty():
        raise UserError(f"{text}: say --yes")
    typer.confirm(f"{text[0].upper()}{text[1:]}. Is it free to move?", abort=True)


def advised(
    card: "Card",
    axis: int,
    excitation: "Excitation",
    program: int | None,
    wish: "Wish | None",
    move: "Move | None",
) -> "Advice":
    """An axis measured, with what can be said of its gains."""
    from openacr.tuning.advice import advise

    measurement = recorded(card, axis, excitation, program)
    with progress_bar("identifying the motor"):
        return advise(measurement, wish, move)


def recorded(
    card: "Card", axis: int, excitation: "Excitation", program: int | None
) -> "Measurement":
    """The response of an axis, with its progress in the terminal."""
    from openacr.tuning.measure import measure

    with progress_bar("recording") as progress:
        return card.perform(
            lambda talk: measure(talk, axis, excitation, program=program, progress=progress)
        )


def report(advice: "Advice", plot: Path | None, *, as_json: bool, with_proposal: bool) -> None:
    """Print the advice, and draw it."""
    from openacr.tuning.advice import advice_data

    if plot is not None:
        from openacr.cli.plots.tune_image import write_tuning

        write_tuning(advice, plot)
    if as_json:
        typer.echo(json.dumps(advice_data(advice)))
    else:
        from openacr.cli.tune_report import lines

        for line in lines(advice, with_proposal=with_proposal):
            typer.echo(line)
    if with_proposal and advice.proposal is None:
        typer.echo(f"error: no gains are proposed: {advice.refusal}", err=True)
        raise typer.Exit(FAILED)
