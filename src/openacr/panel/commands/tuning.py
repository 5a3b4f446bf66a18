"""Commands of servo tuning: measure an axis, set what was proposed."""

from dataclasses import replace
from typing import Annotated

from msgspec import Meta

from openacr.errors import UserError
from openacr.mill.card.setup import GAIN_WORDS
from openacr.mill.config.settings import GAINS
from openacr.mill.session import MillSession
from openacr.panel.commands.registry import command
from openacr.panel.control.engineer.gain_sets import GainSets
from openacr.panel.control.engineer.tuning import Tuning
from openacr.panel.control.machine.installation import Installation
from openacr.panel.control.machine.link import Link
from openacr.panel.control.operator.orders import LATER, Later, Order, answer_with
from openacr.panel.control.settings import StoredSettings
from openacr.panel.roles import Role
from openacr.sysvar import Store
from openacr.sysvar.lookup import known
from openacr.sysvar.values import checked
from openacr.tuning import settings as tuned
from openacr.tuning.excitation import Excitation
from openacr.tuning.propose import Wish

FP32_DIGITS = 7
Positive = Annotated[float, Meta(gt=0.0, le=1e6)]


def _resting(link: Link, name: str, *, is_stored: bool = False) -> int:
    """The number of an axis of a machine that may be moved."""
    session = link.required
    if session.is_set_up:
        session.runner.require_start()
    return link.installation.axis(name, is_stored=is_stored)


@command("tune.gains", Role.SERVICE, needs_control=False)
def tune_gains(session: MillSession, installation: Installation, *, axis: str) -> dict[str, float]:
    """The gains of an axis as the card has them now, by their names on the SERVO page."""
    index = installation.axis(axis)
    values = session.machine.read_rows([row[index] for row in tuned.GAINS.values()])
    return {
        _title(word, index): float(f"{value:.{FP32_DIGITS}g}")
        for word, value in zip(tuned.GAINS, values, strict=True)
    }


@command("tune.sets", Role.SERVICE, needs_control=False)
def tune_sets(
    session: MillSession,
    installation: Installation,
    tuning: Tuning,
    gain_sets: GainSets,
    now_s: float,
    *,
    axis: str,
) -> dict[str, object]:
    """The gains that an axis has had since the panel began, set by set; which is in force.

    The card is asked: what another host has changed is a set `elsewhere`. Each says what it has
    changed of the one before it, and its age in s. `gains` are those in force, by their names on
    the SERVO page.
    """
    index = installation.axis(axis)
    if tuning.moved_axis != index:  # what is tried may be taken back
        gain_sets.look(session, index, now_s)
    return gain_sets.data(index, now_s, lambda word: _title(word, index))


@command("tune.back", Role.SERVICE)
def tune_back(
    session: MillSession,
    installation: Installation,
    tuning: Tuning,
    gain_sets: GainSets,
    settings: StoredSettings,
    now_s: float,
    *,
    axis: str,
    number: int,
    store: bool = False,
) -> dict[str, object]:
    """Set all gains and filters of an axis as a set of `tune.sets` has them."""
    index = installation.axis(axis, is_stored=store)
    if tuning.moved_axis == index:
        raise UserError(f"axis {axis} is measured: wait until it rests, or STOP")
    if store:
        gain_sets.require_kept(index, number)
    changed = gain_sets.set_again(session, index, number, now_s)
    if store:
        cells = installation.store
        for cell, value in _cells(cells, index, changed).items():
            settings.store_at_rest(cell, value)
    return gain_sets.data(index, now_s, lambda word: _title(word, index))


@command("tune.measure", Role.SERVICE, is_motion=True, en="MEASURE", de="MESSEN")
def tune_measure(
    order: Order,
    client: int,
    link: Link,
    tuning: Tuning,
    *,
    axis: str,
    amplitude: Positive = 100.0,
    low_hz: Positive = 2.0,
    high_hz: Positive = 60.0,
    time_s: Positive | None = None,
    bandwidth_hz: Positive | None = None,
    phase_deg: Positive = 55.0,
    integral: bool = True,
) -> Later:
    """Move an axis by a small sine sweep; its motor, its margins, and gains that are proposed.

    Without `time_s`: 1.5 s, or what an empty program has room for.
    """
    index = _resting(link, axis)
    is_shortened = time_s is None
    excitation = Excitation("sine", amplitude, low_hz, high_hz, is_shortened=is_shortened)
    if time_s is not None:
        excitation = replace(excitation, duration_s=time_s)
    wish = Wish(bandwidth_hz, phase_deg, integral)
    measuring = tuning.measure(client, index, excitation, wish)
    answer_with(order, measuring, lambda found: found)
    return LATER


@command("tune.step", Role.SERVICE, is_motion=True, en="STEP", de="SPRUNG")
def tune_step(
    order: Order, client: int, link: Link, tuning: Tuning, *, axis: str, amplitude: Positive = 100.0
) -> Later:
    """Move an axis by a step and back with the gains it has: record, overshoot, rise, settling.

    `amplitude` is in pulses.
    """
    index = _resting(link, axis)
    stepping = tuning.jump(client, index, amplitude)
    answer_with(order, stepping, lambda found: found)
    return LATER


@command("tune.apply", Role.SERVICE, is_motion=True, en="SET THESE GAINS", de="DIESE WERTE SETZEN")
def tune_apply(
    order: Order,
    client: int,
    link: Link,
    tuning: Tuning,
    settings: StoredSettings,
    gain_sets: GainSets,
    now_s: float,
    *,
    axis: str,
    store: bool = False,
) -> Later:
    """Set the gains that were proposed; the card tries them with a step and takes bad ones back."""
    index = _resting(link, axis, is_stored=store)
    if store:
        tuning.require_kept(index)
    cells = _cells(link.installation.store, index, tuning.proposed(index)) if store else {}
    gain_sets.look(link.required, index, now_s)
    applying = tuning.apply(client, index)

    def done(found: dict[str, object]) -> dict[str, object]:
        for cell, value in cells.items():
            settings.store_at_rest(cell, value)
        return found

    answer_with(order, applying, done)
    return LATER


def _title(word: str, axis: int) -> str:
    """How the SERVO page names a gain; a filter has its word."""
    return known(_cell(word, axis)).name if word in tuned.GAINS else word


def _cells(store: Store, axis: int, gains: dict[str, float]) -> dict[int, float]:
    """The parameters of the machine that hold gains; UserError where one may not have its value."""
    found = {}
    for word, value in gains.items():
        cell = known(_cell(word, axis))
        checked(cell, value, store.is_metric, store.letter_of(cell))
        found[cell.number] = value
    return found


def _cell(word: str, axis: int) -> int:
    """The number of the parameter of the machine that holds a gain."""
    return GAINS[GAIN_WORDS.index(word)][axis]
