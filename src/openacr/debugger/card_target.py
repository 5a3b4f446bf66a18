"""A virtual card as the target of the debugger: its programs and PLCs."""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable, Mapping
from pathlib import Path

from openacr.client.program_variables import Value
from openacr.controller.controller import Controller
from openacr.debugger import questions, rungs
from openacr.debugger.breakpoints import watches_of
from openacr.debugger.calls import PROGRAMS, frame_of, frames_of, listing, name_of, owners
from openacr.debugger.card_course import CardCourse
from openacr.debugger.target import NO_STATEMENT, Frame, Place
from openacr.debugger.variables import axis_states, locals_of, program_state, time_state
from openacr.errors import UserError


class CardTarget:
    """What is seen of a debugged card, and where it can stop."""

    def __init__(self, card: Controller, show: Callable[[str], None] = lambda text: None) -> None:
        """`show` gets the texts of breakpoints that print, and conditions that fail."""
        self.card = card
        self.course = CardCourse(card, show)

    @property
    def capabilities(self) -> Mapping[str, object]:
        """None: what a virtual card can do is the rule."""
        return {}

    def close(self) -> None:
        """Do nothing: the card ends with its process."""

    def owners(self) -> list[tuple[int, str]]:
        """The programs and PLCs that have a text; PROG0 if there is none."""
        return [(owner, name_of(owner)) for owner in owners(self.card) or [0]]

    def frames(self, owner: int) -> list[Frame]:
        """The line that a program executes next or waits in, then those that called it.

        Of a PLC it is the line whose coil has changed, where that has stopped the card.
        """
        if owner < PROGRAMS:
            present = frames_of(self.card, owner) if owner >= 0 else []
        else:
            rung = self.course.rung_at(owner)
            present = [] if rung is None else [frame_of(self.card, owner, rung)]
        found = []
        for each in present:
            name = f"{name_of(owner)} line {each.line}"
            if each.path:
                found.append(Frame(name, each.file_line, each.path))
            else:
                place = Sources(self.card).listed_place(owner, each.line)
                found.append(Frame(name, place, f"{name_of(owner)} (listing)", owner + 1))
        return found

    def listing(self, number: int) -> str:
        """The listing of a program; its number is that of the program plus 1."""
        if number - 1 not in owners(self.card):
            raise UserError(f"there is no listing {number}")
        return "\n".join(listing(self.card, number - 1)) + "\n"

    def scopes(self, owner: int, depth: int) -> Iterable[tuple[str, Iterable[Value]]]:
        """The groups of values of a program."""
        rung = self.course.rung_at(owner)
        if rung is not None:
            yield "Rung", rungs.operands(self.card, owner, rung)
            yield "Time", time_state(self.card)
            return
        if not 0 <= owner < PROGRAMS:
            raise UserError(f"there is no program {owner}")
        yield "Variables", locals_of(self.card, owner)
        yield "Axes", axis_states(self.card, owner)
        yield "Program", program_state(self.card, owner)
        yield "Time", time_state(self.card)

    def answer(self, owner: int, expression: str) -> str:
        """The value of an expression at the prompt of a program."""
        return questions.answer(self.card, owner, expression)

    def assign(self, owner: int, target: str, value: str) -> None:
        """Change a value; in the past, this begins another branch."""
        questions.assign(self.card, owner, target, value)

    def typed(self, owner: int, line: str) -> str:
        """What the card answers to a line that is typed at the prompt of a program."""
        return questions.typed(self.card, owner, line)

    def heard(self) -> str:
        """What the card has answered since to the lines that were typed."""
        return questions.heard(self.card)

    def places_of(self, path: str, listing: int, lines: Container[int]) -> dict[int, Place]:
        """The stored lines that come from these of a file or listing."""
        sources = Sources(self.card)
        found = sources.lines_listed(listing - 1) if listing else sources.lines_of(path)
        return {line: place for line, place in found.items() if line in lines}

    def why_no_stop(self, place: Place) -> str:
        """Why the card cannot stop at a line: of a PLC its coils are seen alone."""
        if place[0] >= PROGRAMS:
            return "" if rungs.coils(self.card, *place) else rungs.NO_COIL
        return "" if Sources(self.card).has_statement(*place) else NO_STATEMENT

    def require_watchable(self, name: str) -> None:
        """UserError unless it is a parameter or flag of the card."""
        list(watches_of(self.card, name))

    def steps_lines(self, owner: int) -> bool:
        """Whether it steps line by line: a PLC steps by servo interrupts alone."""
        return owner < PROGRAMS


class Sources:
    """Where the stored lines of a card come from.

    Lines that were typed, or changed since, have no file: a listing of the program on the card
    stands for it.
    """

    def __init__(self, card: Controller) -> None:
        self._card = card

    def lines_of(self, path: str) -> dict[int, tuple[int, int]]:
        """The lines of a file that are stored: file line to program (or PLC, 16-23) and line."""
        wanted = Path(path).resolve()
        found = {}
        for owner in owners(self._card):
            for stored in self._card.system.programs.lines(owner):
                origin = self._card.origin(owner, stored.number)
                if origin is not None and Path(origin[0]).resolve() == wanted:
                    found[origin[1]] = owner, stored.number
        return found

    def has_statement(self, owner: int, number: int) -> bool:
        """Whether a line of a program is executed: labels and remarks alone are not."""
        lines = self._card.system.programs.lines(owner)
        return any(any(stored.tree.blocks) for stored in lines if stored.number == number)

    def lines_listed(self, owner: int) -> dict[int, tuple[int, int]]:
        """The same for the listing of a program: its first line is 1."""
        lines = self._card.system.programs.lines(owner)
        return {place: (owner, stored.number) for place, stored in enumerate(lines, 1)}

    def listed_place(self, owner: int, line: int) -> int:
        """The place of a stored line in the listing of its program, from 1."""
        numbers = [stored.number for stored in self._card.system.programs.lines(owner)]
        return numbers.index(line) + 1 if line in numbers else 1
