"""The first difference of two branches: outputs, positions and lines, to the tick."""

from collections.abc import Callable

import pytest
from tests.controller.hosts import X_AND_Y, Host

from openacr.controller import Controller
from openacr.map.rows import axes
from openacr.timeline import Timeline
from openacr.timeline.details import line_of
from openacr.timeline.differing import Difference, Seen, apart_tk, first_differences

OUTPUTS = Seen([4097, 4105])
LINES = ("10 IF (BIT128) THEN GOTO 40", "20 DWL 0.02", "30 GOTO 10", "40 SET 36", "50 DWL 9")
LATE_TK = 300


@pytest.fixture
def timeline() -> Timeline:
    """Program 4 sets output 36 once flag 128 is set; X and Y stand."""
    card = Controller()
    host = Host(card)
    host.type(*X_AND_Y)
    host.type("PROG4", *LINES, "PROG0")
    timeline = Timeline(card)
    host.type("RUN PROG4")
    timeline.advance(1000)
    host.type("SET 150")  # an input that branch 1 does not have
    timeline.advance(1000)
    return timeline


def branched(timeline: Timeline, tick: int, *lines: str) -> None:
    """Begin branch 1 at a tick by typed lines, up to the end of branch 0."""
    end = timeline.card.lived_tk
    timeline.seek(tick)
    timeline.card.receive(
        timeline.card.streams.numbers[0], "".join(f"{a}\r" for a in lines).encode()
    )
    timeline.advance(end - tick)


def found(timeline: Timeline, first: int, last: int) -> list[Difference]:
    one, other = (timeline.course(number, first, last) for number in (0, 1))
    differences = first_differences(one, other, first, last, OUTPUTS)
    swapped = first_differences(other, one, first, last, OUTPUTS)
    assert swapped == [each._replace(values=each.values[::-1]) for each in differences]
    return differences


def first_tick(timeline: Timeline, last: int, holds: Callable[[Controller], bool]) -> int:
    """The first tick of branch 1 in which something holds, looked at one by one."""
    ticks = range(LATE_TK, last + 1)
    cards = timeline.course(1, LATE_TK, last).moments(ticks)
    return next(tick for tick, card in zip(ticks, cards, strict=True) if holds(card))


def test_a_line_that_another_value_leads_to_is_the_first_difference_then_its_output(
    timeline: Timeline,
) -> None:
    branched(timeline, LATE_TK, "SET 128")
    assert apart_tk(*timeline.branches) == apart_tk(*reversed(timeline.branches)) == LATE_TK
    output, line = found(timeline, LATE_TK, LATE_TK + 400)
    first = first_tick(timeline, LATE_TK + 400, lambda card: card.bit[36])
    assert output == Difference("output", first, 4, (0, 1))
    assert line == Difference("line", first, 4, (20, 40))  # all in the tick of line 10
    assert found(timeline, LATE_TK, first - 1) == []


def test_an_output_that_is_set_between_two_ticks_differs_from_that_tick_on(
    timeline: Timeline,
) -> None:
    branched(timeline, LATE_TK, "SET 289")
    assert found(timeline, LATE_TK, LATE_TK + 9) == [Difference("output", LATE_TK, 33, (0, 1))]


def test_positions_differ_at_the_tick_in_which_an_axis_moves(timeline: Timeline) -> None:
    branched(timeline, LATE_TK, "Y1")
    setpoint, actual = found(timeline, LATE_TK, LATE_TK + 200)
    one, other = setpoint.values
    assert (setpoint.kind, setpoint.number, one) == ("setpoint", 1, 0.0)
    assert other != 0.0
    row = axes.psp_cnt[1]
    first = first_tick(timeline, LATE_TK + 200, lambda card: card.memory.F[row] != 0.0)
    assert setpoint.tick == first
    assert (actual.kind, actual.number) == ("actual", 1)
    assert actual.tick >= first
    assert found(timeline, LATE_TK, first - 1) == []


def test_branches_are_apart_from_the_first_input_that_one_of_them_lacks(
    timeline: Timeline,
) -> None:
    timeline.seek(LATE_TK)
    timeline.fork()
    timeline.advance(50)
    one, other = timeline.branches
    assert apart_tk(one, one) is None
    assert apart_tk(one, other) == apart_tk(other, one) == 1000
    timeline.card.receive(timeline.card.streams.numbers[0], b"SET 129\r")
    assert apart_tk(one, other) == apart_tk(other, one) == LATE_TK + 50


def test_the_earlier_of_two_different_lines_is_named_with_the_line_of_the_other_branch(
    timeline: Timeline,
) -> None:
    branched(timeline, LATE_TK, "HALT PROG4")
    timeline.seek(LATE_TK + 10)
    timeline.card.receive(timeline.card.streams.numbers[0], b"RUN PROG4\r")
    timeline.advance(100)
    one, other = timeline.branches[0], timeline.branch
    span = (LATE_TK - 100, LATE_TK + 100)
    late = (LATE_TK, LATE_TK + 100)
    again = line_of(timeline.course(other.number, *late), 4, 10, *late, is_last=False)
    later = line_of(timeline.course(0, *late), 4, 30, *late, is_last=False)
    assert again is not None
    assert later is not None
    assert LATE_TK + 10 <= again < later
    first, second = (timeline.course(each.number, *span) for each in (one, other))
    (line,) = first_differences(first, second, *span, OUTPUTS)
    assert line == Difference("line", again, 4, (20, 10))


def test_a_program_that_has_ended_stays_at_its_last_line(timeline: Timeline) -> None:
    branched(timeline, LATE_TK, "HALT PROG4")
    (line,) = found(timeline, LATE_TK - 50, LATE_TK + 200)
    assert line.tick > LATE_TK
    assert set(line.values) < {10, 20, 30}
    assert line.values[0] != line.values[1]
    span = (LATE_TK - 50, LATE_TK + 200)
    one, other = (timeline.course(number, *span) for number in (0, 1))
    assert first_differences(one, other, *span, Seen([], programs=0xFFEF)) == []
