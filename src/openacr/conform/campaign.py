"""Cases of all sections, or of some, on one card: which agree, which differ, which do not run."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from openacr.conform.asking import NOTHING, bar
from openacr.conform.facts import lacking
from openacr.conform.form import Case, DifferenceError
from openacr.conform.host import HostCard
from openacr.conform.moving import AT_REST, Permission, for_axis, of_axis
from openacr.conform.read import files, read
from openacr.conform.run import run
from openacr.conform.targets import world_of
from openacr.errors import UserError
from openacr.models import MODELS, Model

RETURN_S = 60.0  # for the return after a case that moves an axis
OTHER_MODEL = "not for this model"
RESULTS = ("agrees", "differs", "not run", OTHER_MODEL)
_MADE_ID = re.compile(r"^proves:(?:[^({\n]|\([^)]*\))*\{", re.MULTILINE)  # an id from a table


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of a case: it agreed, it differs, or why it was not run."""

    case: Case
    difference: DifferenceError | None = None
    bar: str = ""
    is_of_others: bool = False  # it is about cards of other models

    @property
    def result(self) -> str:
        """One of RESULTS."""
        if self.is_of_others:
            return OTHER_MODEL
        if self.bar:
            return "not run"
        return "differs" if self.difference else "agrees"

    @property
    def section(self) -> str:
        """Manual and section, as the folders and files are named."""
        return _section(self.case.path)

    def data(self) -> dict[str, object]:
        """The outcome as JSON data."""
        case, difference = self.case, self.difference
        found: dict[str, object] = {
            "section": self.section,
            "case": case.name,
            "line": case.line,
            "result": self.result,
            "proves": [claim.id for claim in case.proves],
            "source": case.source,
            "rests_on": case.rests,
        }
        if self.bar:
            found["why"] = self.bar
        if difference:
            at = difference.at
            found |= {
                "at_line": at.number if at else case.line,
                "step": at.text.strip() if at else "",
                "expected": difference.expected,
                "shown": difference.shown,
            }
        return found


def chosen(folder: Path, areas: Sequence[str]) -> list[Case]:
    """The cases of the sections, or with the ids, that have one of some words in their names.

    UserError for a word that nothing has, and for a folder without cases.
    """
    paths = files(folder)
    if not paths:
        raise UserError(f"{folder}: no files of cases here")
    likely = [path for path in paths if not areas or any(_may_have(path, area) for area in areas)]
    cases = [case for path in likely for case in read(path)]
    for area in areas:
        if not any(_is_of(case, area) for case in cases):
            names = dict.fromkeys(path.stem.partition("-")[2] for path in paths)
            raise UserError(f"--area {area}: the sections are {', '.join(names)}; or an id")
    return [case for case in cases if not areas or any(_is_of(case, area) for area in areas)]


def _may_have(path: Path, area: str) -> bool:
    """Whether a file may have cases of an area; to read all files takes a second."""
    if area.lower() in _section(path).lower():
        return True
    if "-" not in area:  # no id
        return False
    text = path.read_text(encoding="utf-8", errors="replace")
    return area.upper() in text or _MADE_ID.search(text) is not None


def _is_of(case: Case, area: str) -> bool:
    is_claimed = any(claim.id.startswith(area.upper()) for claim in case.proves)
    return ("-" in area and is_claimed) or area.lower() in _section(case.path).lower()


def _section(path: Path) -> str:
    """Manual and section, as the folders and files are named."""
    return f"{path.parent.name}/{path.stem}"


def on_virtual_card(cases: Iterable[Case], model: str) -> Iterator[Outcome]:
    """Each case on a virtual card of a model, as new."""
    for case in cases:
        if reason := other_model(case, world_of(case.machine, model).card.board):
            yield Outcome(case, bar=reason, is_of_others=True)
        else:
            yield Outcome(case, run(case, model=model))


def other_model(case: Case, model: Model) -> str:
    """Why a case is about cards of other models; empty if it is not."""
    if case.model not in ("", model.name):
        return f"it is about the {case.model}"
    return lacking(case.needs, model)


def on_card_in_use(
    cases: Iterable[Case], card: HostCard, model: str, permission: Permission = NOTHING
) -> Iterator[Outcome]:
    """Each case that is permitted, on a card of a model that others use; a link error ends it.

    After a case that moves an axis it is jogged to where it was. If the run ends meanwhile, by an
    error or by Ctrl-C, all motion of the axis is killed. A card of a model that is not known is
    asked only what holds for all models.
    """
    for case in cases:
        is_of_one = bool(case.model or case.needs)
        if is_of_one and model not in MODELS:
            yield Outcome(case, bar="it is about some models, and that of the card is not known")
            continue
        if is_of_one and (reason := other_model(case, MODELS[model])):
            yield Outcome(case, bar=reason, is_of_others=True)
            continue
        if reason := bar(case, permission):
            yield Outcome(case, bar=reason)
            continue
        card.align()
        if case.moves is None or permission.axis is None:
            yield Outcome(case, run(case, card))
        else:
            yield Outcome(case, _moved(for_axis(case, permission.axis), card, permission.axis))
    card.align()


def _moved(case: Case, card: HostCard, axis: int) -> DifferenceError | None:
    """Run a case that moves an axis, and return the axis to where it was."""
    try:
        begin_u = card.ask(of_axis("P12297/P12375", axis))
        difference = run(case, card)
        card.align()
        card.type(f"AXIS{axis} JOG ABS {begin_u:.9g}")
        card.until(of_axis(AT_REST, axis), RETURN_S)
    except BaseException:
        card.stop(axis)
        raise
    return difference
