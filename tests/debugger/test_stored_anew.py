"""A card over a link whose programs are stored anew while it is debugged."""

from collections.abc import Callable
from typing import TypeVar, cast

from openacr.client import Card, Level
from openacr.client.program_states import ROWS, ProgramState, program_states
from openacr.controller import Controller
from openacr.debugger.real_cards.followers import Followers
from openacr.debugger.real_cards.link import CardLink
from openacr.debugger.real_cards.target import RealCardTarget

T = TypeVar("T")


class Link:
    """The link to a card in this process."""

    lost = ""

    def __init__(self) -> None:
        self.card = Card.open(Controller())

    def do(self, act: Callable[[Card], T]) -> T:
        return act(self.card)

    def states(self) -> list[ProgramState]:
        return program_states(self.card.read_many(ROWS))

    poll = states


class Silent:
    """Nothing is followed."""

    def heard(self) -> tuple[()]:
        return ()


def store(card: Card, *lines: str) -> None:
    card.go(Level.program(0))
    for line in ("NEW", *lines):
        card.command(line)


def test_the_listing_of_a_program_that_has_begun_again_is_read_anew() -> None:
    link = Link()
    for line in ("DIM PROG0(1000)", "DIM P(10)"):
        link.card.command(line)
    store(link.card, "10 _LOOP", "20 GOTO LOOP")
    target = RealCardTarget(
        cast(CardLink, link), cast(Followers, Silent()), [], is_held_at_start=False
    )
    store(link.card, "10 P1=1", "15 P2=2", "17 _LOOP", "20 DWL 1", "30 GOTO LOOP")
    link.card.run(0)
    link.card.pause(0.1)
    assert target.course.run(1) is None
    (frame,) = target.frames(0)
    assert (frame.name, frame.line) == ("PROG0 line 20", 4)
