"""Whatever is done on a timeline, each moment of each branch keeps its state."""

from hypothesis import example, given
from hypothesis import strategies as st
from tests.controller.hosts import X_AND_Y, Host
from tests.search import search

from openacr.controller import Controller
from openacr.controller.snapshot import Snapshot
from openacr.timeline import Moment, Timeline

PROGRAMS = (
    ("PROG0", "10 X10 Y5", "20 P0=P0+1", "30 X0 Y0", "40 GOTO 10"),
    ("PROG1", "10 P1=P1+P9", "20 P2=P2+P1 : P3=P3-1", "30 IF (BIT5) THEN P4=P4+1", "40 GOTO 10"),
)
_begun: list[Snapshot] = []


def begun() -> Controller:
    """A card with two running programs."""
    card = Controller()
    if not _begun:
        host = Host(card)
        host.type("SYS", "DIM P(10)", *X_AND_Y)
        for lines in PROGRAMS:
            host.type(*lines)
            host.type("RUN")
        card.advance(200)
        _begun.append(card.snapshot())
    card.take_over(_begun[0])
    return card


def to_line(timeline: Timeline, number: int) -> None:
    """Advance to the next line with this number, for 50 ticks at most, and take its inputs.

    A line ends `advance` before the inputs that came while the card stood there.
    """
    timeline.card.announce_lines(3, lambda program, line: line == number)
    timeline.advance(50)
    timeline.card.announce_lines()
    timeline.seek(timeline.now)


forward = st.tuples(st.just("advance"), st.integers(0, 300))
line = st.tuples(st.just("line"), st.sampled_from([10, 20, 30, 40]))
write = st.tuples(st.just("write"), st.integers(1, 9))
switch = st.tuples(st.just("input"), st.integers(0, 1))
back = st.tuples(st.just("seek"), st.integers(0, 1000))
other = st.tuples(st.just("branch"), st.integers(0, 5))


TRAVELS = st.lists(st.one_of(forward, line, line, write, switch, back, other), max_size=25)


@search(1000, part=50)
@example([("advance", 0), ("line", 10), ("write", 1), ("seek", 0), ("line", 10)])
@given(TRAVELS)
def test_each_moment_of_each_branch_keeps_its_state(steps: list[tuple[str, int]]) -> None:
    timeline = Timeline(begun(), keyframe_every_s=0.05)
    card = timeline.card
    known: dict[tuple[int, Moment], str] = {}
    for what, number in steps:
        if what == "advance":
            timeline.advance(number)
        elif what == "line":
            to_line(timeline, number)
        elif what == "write":
            card.p[number] = number
        elif what == "input":
            card.set_input(5, bool(number))
        elif what == "branch":
            timeline.switch(number % len(timeline.branches))
        else:
            places = [moment for branch, moment in known if branch == timeline.branch.number]
            if places:
                timeline.seek(places[number % len(places)])
        at = timeline.branch.number, timeline.now
        if what in ("write", "input"):
            known[at] = card.digest()
        assert known.setdefault(at, card.digest()) == card.digest()
    for (branch, moment), digest in known.items():
        timeline.switch(branch)
        timeline.seek(moment)
        assert card.digest() == digest
