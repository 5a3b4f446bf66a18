"""A card over a link as the target of the debugger, with what is seen of it.

It answers as its terminal does; nothing of it goes back.
"""

from __future__ import annotations

import logging
from collections.abc import Collection, Iterable, Mapping, Sequence

from openacr.client import Level
from openacr.client.program_states import PROGRAMS, ProgramState
from openacr.client.program_variables import Value, answer, assign, variables
from openacr.client.stored import ListedLine
from openacr.debugger.breakpoints import Fault
from openacr.debugger.real_cards import values
from openacr.debugger.real_cards.course import RealCardCourse, not_watched
from openacr.debugger.real_cards.ending import end
from openacr.debugger.real_cards.followers import Followers
from openacr.debugger.real_cards.link import CardLink
from openacr.debugger.target import Frame, Place
from openacr.errors import OpenacrError, UserError

log = logging.getLogger(__name__)

CAPABILITIES = {
    "supportsConditionalBreakpoints": False,
    "supportsHitConditionalBreakpoints": False,
    "supportsLogPoints": False,
    "supportsDataBreakpoints": False,
    "supportsStepBack": False,
    "supportsSteppingGranularity": False,
    "exceptionBreakpointFilters": [
        {"filter": Fault.PROGRAM, "label": "Errors that end a program (LISTEN)", "default": True},
    ],
}
NO_LINES = "a PLC has no lines to stop at"
NO_BREAKPOINTS = (
    "a card over a link cannot stop before a line by itself: step, or write PAUSE into the program"
)


class RealCardTarget:
    """What is seen of a card over a link.

    Owners are the programs (0-15) and PLCs (16-23) with a text.
    """

    def __init__(
        self, link: CardLink, followers: Followers, run: Sequence[int], *, is_held_at_start: bool
    ) -> None:
        """Read which programs there are. ClientError, UserError."""
        self.link, self.followers = link, followers
        self.course = RealCardCourse(link, followers, run, is_held_at_start=is_held_at_start)
        self.course.on_new_text = self._forget_text
        self._listings: dict[int, list[ListedLine]] = {}
        rooms = link.do(lambda card: card.rooms())
        self._owners = [
            owner
            for owner, state in enumerate(self.course.states)
            if state.is_running or (state.level in rooms and self._lines(owner))
        ]

    @property
    def capabilities(self) -> Mapping[str, object]:
        """What a card over a link cannot do."""
        return CAPABILITIES

    def close(self) -> None:
        """HALT what was started here and end moves that were typed; the rest stays as it is."""
        self.followers.close()
        try:
            if self.course.started or self.course.commanded:
                end(
                    self.link.last_card(),
                    self.course.started,
                    self.course.commanded,
                    self.course.paused_here,
                )
        except OpenacrError as failure:
            log.warning("the programs may go on: %s", failure)
        finally:
            self.link.close()

    # what is seen

    def owners(self) -> list[tuple[int, str]]:
        """The programs and PLCs that had a text when they were read; PROG0 if there was none."""
        return [(owner, _name(owner)) for owner in self._owners or [0]]

    def frames(self, owner: int) -> list[Frame]:
        """The line that a program has executed last: the card names no other."""
        state = self._state(owner)
        if owner not in PROGRAMS or not (state.is_running or owner in self.course.faults):
            return []
        numbers = [line.number for line in self._lines(owner)]
        place = numbers.index(state.line) + 1 if state.line in numbers else 1
        name = f"{_name(owner)} line {state.line}" if state.line else f"{_name(owner)} begins"
        return [Frame(name, place, f"{_name(owner)} (listing)", owner + 1)]

    def _lines(self, owner: int) -> list[ListedLine]:
        if owner not in self._listings:
            level = self.course.states[owner].level
            self._listings[owner] = self.link.do(lambda card: card.listing(level))
        return self._listings[owner]

    def _forget_text(self, owner: int) -> None:
        """Read the listing of a program anew when it is needed."""
        self._listings.pop(owner, None)

    def _state(self, owner: int) -> ProgramState:
        if not 0 <= owner < len(self.course.states):
            raise UserError(f"there is no program {owner}")
        return self.course.states[owner]

    def listing(self, number: int) -> str:
        """The listing of a program or PLC; its number is that of the owner plus 1."""
        if number - 1 not in dict(self.owners()):
            raise UserError(f"there is no listing {number}")
        self._forget_text(number - 1)  # it may have been stored anew
        return "".join(f"{line.number} {line.text.strip()}\n" for line in self._lines(number - 1))

    def scopes(self, owner: int, depth: int) -> Iterable[tuple[str, Iterable[Value]]]:
        """The groups of values of a program."""
        if owner not in PROGRAMS:
            raise UserError(f"there is no program {owner}")
        yield (
            "Variables",
            self.link.do(lambda card: card.perform(lambda talk: variables(talk, owner))),
        )
        yield "Axes", self.link.do(lambda card: list(values.axis_states(card, owner)))
        yield "Program", self._about(owner)

    def _about(self, owner: int) -> list[Value]:
        state = self._state(owner)
        about = [Value("state", state.does), Value("line executed last", str(state.line))]
        return about + [Value("error", text) for text in [self.course.faults.get(owner)] if text]

    def answer(self, owner: int, expression: str) -> str:
        """The value of an expression at the prompt of a program."""
        program = _prompt(owner)
        return self.link.do(
            lambda card: card.perform(lambda talk: answer(talk, program, expression))
        )

    def assign(self, owner: int, target: str, value: str) -> None:
        """Change a variable, parameter or flag."""
        program = _prompt(owner)
        self.link.do(lambda card: card.perform(lambda talk: assign(talk, program, target, value)))

    def typed(self, owner: int, line: str) -> str:
        """The answer to a line at the prompt of a program; its moves end with the session."""
        program = _prompt(owner)
        self.course.commanded.add(program)
        self._listings.clear()
        lines = self.link.do(lambda card: card.command(line, program=program))
        return "".join(f"{each}\n" for each in lines)

    def heard(self) -> str:
        """Nothing: answers of the card are complete."""
        return ""

    # where it stops

    def places_of(self, path: str, listing: int, lines: Collection[int]) -> dict[int, Place]:
        """The lines of a listing; of files all, since the card does not know them."""
        if not listing:
            return {line: (0, line) for line in lines}
        found = enumerate(self._lines(listing - 1), 1)
        return {line: (listing - 1, each.number) for line, each in found if line in lines}

    def why_no_stop(self, place: Place) -> str:
        """Why no line is a breakpoint."""
        return NO_BREAKPOINTS if place[0] in PROGRAMS else NO_LINES

    def require_watchable(self, name: str) -> None:
        """Refuse: changes are watched on virtual cards alone."""
        raise not_watched(name)

    def steps_lines(self, owner: int) -> bool:
        """True: it never steps by servo interrupts."""
        return True


def _name(owner: int) -> str:
    return str(Level.program(owner) if owner in PROGRAMS else Level.plc(owner - len(PROGRAMS)))


def _prompt(owner: int) -> int:
    """The program at whose prompt lines are typed: PROG0 for a PLC."""
    return owner if owner in PROGRAMS else 0
