"""A part program as the target of the debugger: the machine of a store, on a virtual card."""

from __future__ import annotations

import re
from collections.abc import Callable, Container, Iterable, Iterator, Mapping
from functools import cached_property
from pathlib import Path

from openacr.client.program_variables import Value
from openacr.cnc.loading.load import Folders
from openacr.cnc.program.labels import Part
from openacr.cnc.program.program import Program
from openacr.cnc.reading.findings import CodeError
from openacr.cnc.reading.grammar import Grammar
from openacr.cnc.reading.parser import parse
from openacr.cnc.reading.text import decoded
from openacr.debugger import questions
from openacr.debugger.breakpoints import Fault
from openacr.debugger.part_programs.blocks import Block, BlockLog
from openacr.debugger.part_programs.course import PartCourse, not_watched
from openacr.debugger.part_programs.run import LiveRun
from openacr.debugger.part_programs.values import (
    modal_values,
    offset_values,
    parameter_values,
    position_values,
    value_of,
)
from openacr.debugger.target import Frame, Place
from openacr.debugger.variables import axis_states, time_state
from openacr.errors import UserError
from openacr.mill.config.folders import folders_of
from openacr.mill.plan.estimate.checking import opened
from openacr.mill.session import MillSession, Start
from openacr.sysvar import Store
from openacr.timeline import Timeline

REST_S = 90.0  # longer than any wait of an ending
CAPABILITIES = {
    "supportsDataBreakpoints": False,
    "exceptionBreakpointFilters": [
        {"filter": Fault.PROGRAM, "label": "Alarms", "default": True},
    ],
}
_PARAMETER = re.compile(r"\s*[P#]\s*(\d{1,7})\s*", re.IGNORECASE)


class PartTarget:
    """What is seen of the run of a part program, and where it can stop."""

    def __init__(
        self, file: Path, store: Store, dialect: str | None, show: Callable[[str], None]
    ) -> None:
        """UserError for a program that cannot be started."""
        program, choice = opened(file, store, dialect)
        if program.errors:
            more = len(program.errors) - 1
            rest = f" (and {more} more: `openacr mill check`)" if more else ""
            raise UserError(f"{program.errors[0]}{rest}")
        self.shop = shop = MillSession.virtual(store, lambda text: show(f"{text}\n"))
        card = shop.virtual_card
        if card is None:
            raise UserError("a part program is debugged on a virtual card")
        card.is_journalled = False
        self.program, self.dialect = program, choice.name
        self._file, self._show = file, show
        self._folders = folders_of(store, store.path.parent if store.path else None)
        self.card, self.log = card, BlockLog()
        timeline = Timeline(card)  # of inputs, those of the start included
        shop.reader = self.log
        shop.start(program, Start(dialect=choice.name, is_repeated=False))
        live = LiveRun(shop, card, self.log)
        self.course = PartCourse(live, self.log, timeline, self._texts, self.answer_at, show)

    @property
    def capabilities(self) -> Mapping[str, object]:
        """Where it differs from a card: no data breakpoints."""
        return CAPABILITIES

    def close(self) -> None:
        """Bring the machine to rest, outputs off first; it ends with its process."""
        if self.course.timeline.is_past:
            self.course.timeline.seek(self.course.timeline.branch.last)
        self.shop.runner.bring_to_rest()
        self.course.live.advance(
            round(REST_S / self.card.period_s), until=lambda: not self.course.live.is_busy
        )
        self.shop.close()

    # what is seen

    @property
    def _block(self) -> Block | None:
        return self.log[self.course.at] if self.course.live.reached_cnt else None

    def owners(self) -> list[tuple[int, str]]:
        """The part program."""
        return [(0, self._file.name)]

    def frames(self, owner: int) -> list[Frame]:
        """The present block, then the lines that have called its routine."""
        block = self._block
        if owner or block is None:
            return []
        places = [block.place, *reversed(block.callers)]
        return [
            Frame(f"{name} line {line}", line, self._paths.get(name, name)) for name, line in places
        ]

    @cached_property
    def _paths(self) -> dict[str, str]:
        """The files of the texts of the program."""
        found = {}
        folders: Folders = self._folders
        places = [self._file.parent, *filter(None, (folders.library, folders.customs))]
        for part in self._parts():
            name = part.text.name
            paths = [place / name for place in places if (place / name).is_file()]
            if paths:
                found[name] = str(paths[0])
        found[self.program.main.text.name] = str(self._file)
        return found

    def _parts(self) -> Iterator[Part]:
        program: Program = self.program
        yield program.main
        yield from program.parts
        yield from program.includes.values()
        yield from program.customs.values()

    def _texts(self) -> list[str]:
        return [part.text.name for part in self._parts()]

    def listing(self, number: int) -> str:
        """None: the texts of part programs are files."""
        raise UserError(f"there is no listing {number}")

    def scopes(self, owner: int, depth: int) -> Iterable[tuple[str, Iterable[Value]]]:
        """The groups of values before the present block acts."""
        block = self._block
        if owner or block is None:
            raise UserError("the part program has not come to a block")
        yield "Block", modal_values(block)
        yield "Parameters", parameter_values(block, self.log)
        yield "Offsets", offset_values(block, self.log.noted)
        yield "Axes", self._axes(block)
        yield "Time", time_state(self.card)

    def _axes(self, block: Block) -> Iterator[Value]:
        yield from position_values(block, self.log.noted)
        yield from axis_states(self.card, self.shop.machine.master)

    def answer(self, owner: int, expression: str) -> str:
        """The value of an expression of the program before the present block acts."""
        return self.answer_at(self.course.at, expression)

    def answer_at(self, block: int, expression: str) -> str:
        """The value of an expression before a block acts."""
        if not self.course.live.reached_cnt:
            raise UserError("the part program has not come to a block")
        value = value_of(
            expression, self.log[block], self.log.noted, self.card, self.program, self.dialect
        )
        return f"{value:.9g}"

    def assign(self, owner: int, target: str, value: str) -> None:
        """Change a parameter for the blocks that are not read yet; at the latest moment only."""
        found = _PARAMETER.fullmatch(target)
        if found is None:
            raise UserError(f"{target}: what can be changed are parameters P100 to P4095")
        self._require_present()
        number = int(found[1])
        home = self.log.noted.home(number)
        if home.is_on_card or home.write_error():
            raise UserError(f"P{number} is not a parameter that programs write")
        self.log.noted.write(number, float(self.answer(owner, value)))
        last = self.log[self.log.end - 1]
        self._show(f"P{number}: the blocks up to {last.file} line {last.line} are read already\n")

    def typed(self, owner: int, line: str) -> str:
        """What the card answers to a line that is typed at the prompt of PROG0."""
        self._require_present()
        return questions.typed(self.card, 0, line)

    def _require_present(self) -> None:
        if self.course.timeline.is_past:
            raise UserError("the part program has run on from here: only the latest moment changes")

    def heard(self) -> str:
        """What the card has answered since to the lines that were typed."""
        return questions.heard(self.card)

    # where it stops

    def places_of(self, path: str, listing: int, lines: Container[int]) -> dict[int, Place]:
        """Which of these lines of a file of the program are blocks."""
        wanted = Path(path).resolve()
        grammar = self.log.run.dialect.grammar
        found: dict[int, Place] = {}
        for number, part in enumerate(self._parts()):
            file = self._paths.get(part.text.name)
            if file is None or Path(file).resolve() != wanted:
                continue
            for line, text in _lines(part):
                if line in lines and not _is_empty(text, grammar):
                    found[line] = number, line
        return found

    def why_no_stop(self, place: Place) -> str:
        """Empty: it can stop before every block."""
        return ""

    def require_watchable(self, name: str) -> None:
        """Refuse: changes of values are watched on cards alone."""
        raise not_watched(name)

    def steps_lines(self, owner: int) -> bool:
        """Part programs step by blocks."""
        return True


def _lines(part: Part) -> Iterator[tuple[int, str]]:
    line, after = 1, part.text.begin
    while (found := part.text.line(after)) is not None:
        yield line, decoded(found[0])
        line, after = line + 1, found[1]


def _is_empty(text: str, grammar: Grammar) -> bool:
    try:
        block = parse(text, grammar)
    except CodeError:
        return True
    return not (block.words or block.assignments or block.statement or block.messages)
