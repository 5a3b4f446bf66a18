"""What only a card can say of a sweep: before many runs, its ends are tried on one."""

from __future__ import annotations

from collections.abc import Iterator

from openacr.controller import Controller
from openacr.engine.samples import SAMPLES, sample_of_parameter
from openacr.errors import CardError, SourceError, UserError
from openacr.map.numbers import FLAG_LAST
from openacr.plant.describe.complaint import Complaint
from openacr.sweep import design, run, targets
from openacr.sweep.schema import Quantity
from openacr.sweep.study import Point, Study

OFTEN = 0.999  # of a normal distribution values between the 0.1 % ends are tried


def problems(study: Study) -> list[Complaint]:
    """Everything the machine or the card of the project refuses."""
    first = tuple(ends(each)[0] for each in study.quantities.values())
    found = list(_refused_machine(study, first))
    if found:
        return found
    card = run.loaded(study, first)
    try:
        return [*_unknown(study, card), *_refused_settings(study, card, first)]
    finally:
        card.close()


def ends(quantity: Quantity) -> tuple[float, ...]:
    """The lowest and the highest value of a quantity; all of a list."""
    if quantity.values is not None:
        return quantity.values
    return design.at(quantity, 1.0 - OFTEN if quantity.normal else 0.0), design.at(
        quantity, OFTEN if quantity.normal else 1.0
    )


def _refused_machine(study: Study, first: Point) -> Iterator[Complaint]:
    for place, (name, quantity) in enumerate(study.quantities.items()):
        if not targets.is_loaded(quantity):
            continue
        if quantity.machine is not None and study.machine is None:
            yield Complaint(("vary", name, "machine"), f"{name}: the project has no machine.toml")
            continue
        for value in ends(quantity):
            point = (*first[:place], value, *first[place + 1 :])
            try:
                targets.world_of(study, point)
                targets.project_of(study, point)
            except SourceError as error:
                yield Complaint(("vary", name), f"{name} = {value:g}: {error.text}", error.hint)
                break
            except UserError as error:
                yield Complaint(("vary", name), str(error))
                break


def _refused_settings(study: Study, card: Controller, first: Point) -> Iterator[Complaint]:
    for place, (name, quantity) in enumerate(study.quantities.items()):
        if targets.is_loaded(quantity):
            continue
        for value in ends(quantity):
            point = (*first[:place], value, *first[place + 1 :])
            try:
                run.set_values(card, study, point)
            except UserError as error:
                yield Complaint(("vary", name), f"{name} = {value:g}: {error}")
                break


def _unknown(study: Study, card: Controller) -> Iterator[Complaint]:
    """Axes, parameters and flags of the measures that this card does not have."""
    needs = study.needs
    for axis in sorted(needs.axes):
        if axis >= card.model.axes:
            yield Complaint(
                ("measures",),
                f"AXIS{axis}: the {card.model.name} has AXIS0 to AXIS{card.model.axes - 1}",
            )
    for name in sorted(needs.samples | needs.ends):
        if not _exists(card, name):
            yield Complaint(
                ("measures",),
                f"{name}: this card has no such parameter or flag (flags are 0..{FLAG_LAST})",
            )
    if len(needs.samples) > SAMPLES:
        yield Complaint(
            ("measures",),
            f"{len(needs.samples)} parameters and flags are recorded; at most {SAMPLES}",
        )


def _exists(card: Controller, name: str) -> bool:
    if name.startswith("BIT"):
        return int(name[3:]) <= FLAG_LAST
    try:
        card.p[int(name[1:])]
    except CardError:
        return False
    return sample_of_parameter(card.memory, int(name[1:])) is not None
