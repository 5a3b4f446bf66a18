"""Cases of all sections, or of some, on one card: which agree, which differ, which do not run."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from openacr.conform.asking import bar
from openacr.conform.form import Case, DifferenceError
from openacr.conform.host import HostCard
from openacr.conform.read import files, read
from openacr.conform.run import run
from openacr.errors import UserError


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of a case: it agreed, it differs, or why it was not run."""

    case: Case
    difference: DifferenceError | None = None
    bar: str = ""

    @property
    def result(self) -> str:
        """`agrees`, `differs` or `not run`."""
        if self.bar:
            return "not run"
        return "differs" if self.difference else "agrees"

    @property
    def section(self) -> str:
        """Manual and section, as the folders and files are named."""
        return f"{self.case.path.parent.name}/{self.case.path.stem}"

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
    cases = [case for path in files(folder) for case in read(path)]
    if not cases:
        raise UserError(f"{folder}: no files of cases here")
    for area in areas:
        if not any(_is_of(case, area) for case in cases):
            names = dict.fromkeys(case.path.stem.partition("-")[2] for case in cases)
            raise UserError(f"--area {area}: the sections are {', '.join(names)}; or an id")
    return [case for case in cases if not areas or any(_is_of(case, area) for area in areas)]


def _is_of(case: Case, area: str) -> bool:
    place = f"{case.path.parent.name}/{case.path.stem}".lower()
    return area.lower() in place or any(claim.id.startswith(area.upper()) for claim in case.proves)


def on_virtual_card(cases: Iterable[Case], model: str) -> Iterator[Outcome]:
    """Each case on a virtual card of a model, as new."""
    for case in cases:
        if case.model not in ("", model):
            yield Outcome(case, bar=f"it is about the {case.model}")
        else:
            yield Outcome(case, run(case, model=model))


def on_card_in_use(cases: Iterable[Case], card: HostCard) -> Iterator[Outcome]:
    """Each case that only asks, on a card that others use; a link error ends it."""
    for case in cases:
        if reason := bar(case):
            yield Outcome(case, bar=reason)
            continue
        card.align()
        yield Outcome(case, run(case, card))
    card.align()
