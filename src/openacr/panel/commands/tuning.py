"""Commands of servo tuning: measure an axis, set what was proposed."""

from dataclasses import replace
from typing import Annotated

from msgspec import Meta

from openacr.mill.card.setup import GAIN_WORDS
from openacr.mill.config.settings import GAINS
from openacr.panel.commands.registry import Args, command
from openacr.panel.control.orders import LATER, Later, Order, answer_with
from openacr.panel.control.station import Station
from openacr.panel.roles import Role
from openacr.sysvar.lookup import known
from openacr.sysvar.values import checked
from openacr.tuning import settings as tuned
from openacr.tuning.excitation import Excitation
from openacr.tuning.propose import Wish

FP32_DIGITS = 7
Positive = Annotated[float, Meta(gt=0.0, le=1e6)]


class OfAxis(Args, frozen=True):
    """An axis by its name, or AXIS2 for one that the machine does not have."""

    axis: str


class OfMeasurement(OfAxis, frozen=True, kw_only=True):
    """A sine sweep, and what the gains that are proposed should do."""

    amplitude: Positive = 100.0
    low_hz: Positive = 2.0
    high_hz: Positive = 60.0
    time_s: Positive | None = None  # None: 1.5, or what an empty program has room for
    bandwidth_hz: Positive | None = None
    phase_deg: Positive = 55.0
    integral: bool = True


class OfStep(OfAxis, frozen=True, kw_only=True):
    """A step of an axis, in pulses."""

    amplitude: Positive = 100.0


class OfProposal(OfAxis, frozen=True, kw_only=True):
    """Whether what was proposed is also stored in the parameters of the machine."""

    store: bool = False


def _resting(station: Station, name: str, *, is_stored: bool = False) -> int:
    """The number of an axis of a machine that may be moved."""
    session = station.link.required
    if session.is_set_up:
        session.runner.require_start()
    return station.installation.axis(name, is_stored=is_stored)


@command("tune.gains", Role.SERVICE, needs_control=False)
def tune_gains(station: Station, order: Order, args: OfAxis) -> dict[str, float]:
    """The gains of an axis as the card has them now, by their names on the SERVO page."""
    session = station.link.required
    axis = station.installation.axis(args.axis)
    values = session.machine.read_rows([row[axis] for row in tuned.GAINS.values()])
    return {
        known(_cell(word, axis)).name: float(f"{value:.{FP32_DIGITS}g}")
        for word, value in zip(tuned.GAINS, values, strict=True)
    }


@command("tune.measure", Role.SERVICE, is_motion=True)
def tune_measure(station: Station, order: Order, args: OfMeasurement) -> Later:
    """Move an axis by a small sine sweep; its motor, its margins, and gains that are proposed."""
    axis = _resting(station, args.axis)
    is_shortened = args.time_s is None
    excitation = Excitation(
        "sine", args.amplitude, args.low_hz, args.high_hz, is_shortened=is_shortened
    )
    if args.time_s is not None:
        excitation = replace(excitation, duration_s=args.time_s)
    wish = Wish(args.bandwidth_hz, args.phase_deg, args.integral)
    measuring = station.tuning.measure(order.person.client, axis, excitation, wish)
    answer_with(order, measuring, lambda found: found)
    return LATER


@command("tune.step", Role.SERVICE, is_motion=True)
def tune_step(station: Station, order: Order, args: OfStep) -> Later:
    """Move an axis by a step and back with the gains it has: record, overshoot, rise, settling."""
    axis = _resting(station, args.axis)
    stepping = station.tuning.jump(order.person.client, axis, args.amplitude)
    answer_with(order, stepping, lambda found: found)
    return LATER


@command("tune.apply", Role.SERVICE, is_motion=True)
def tune_apply(station: Station, order: Order, args: OfProposal) -> Later:
    """Set the gains that were proposed; the card tries them with a step and takes bad ones back."""
    axis = _resting(station, args.axis, is_stored=args.store)
    if args.store:
        station.tuning.require_kept(axis)
    cells = _cells(station, axis, station.tuning.proposed(axis)) if args.store else {}
    applying = station.tuning.apply(order.person.client, axis)

    def done(found: dict[str, object]) -> dict[str, object]:
        for cell, value in cells.items():
            station.settings.store_at_rest(cell, value)
        return found

    answer_with(order, applying, done)
    return LATER


def _cells(station: Station, axis: int, gains: dict[str, float]) -> dict[int, float]:
    """The parameters of the machine that hold gains; UserError where one may not have its value."""
    store, found = station.installation.store, {}
    for word, value in gains.items():
        cell = known(_cell(word, axis))
        checked(cell, value, store.is_metric, store.letter_of(cell))
        found[cell.number] = value
    return found


def _cell(word: str, axis: int) -> int:
    """The number of the parameter of the machine that holds a gain."""
    return GAINS[GAIN_WORDS.index(word)][axis]
